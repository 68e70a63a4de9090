"""uuv_simulator and DAVE."""
