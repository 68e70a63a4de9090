.PHONY: gallery test

gallery:
	python3 start.py gallery

test:
	python3 start.py test
