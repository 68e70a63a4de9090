"""Cards of nouns in notebooks: nouns stand below what draws them, which is named here from above.

``coeflab/__init__``, which every import of a part of coeflab runs first, says where the renderers are; nothing is imported until
a notebook asks for a card.
"""

from __future__ import annotations

from collections.abc import Callable

Renderer = Callable[[object], str]
_SOURCES: list[Callable[[str], Renderer]] = []


def drawn_by(source: Callable[[str], Renderer]) -> None:
    """Say who draws the cards; the last one who is named does.

    Parameters
    ----------
    source : callable
        The renderer of a name, such as ``fit``.
    """
    _SOURCES[:] = [source]


def html_by(renderer: str, noun: object) -> str:
    """HTML of a noun, by the renderer of that name; its one line where nobody draws cards."""
    from html import escape

    return _SOURCES[0](renderer)(noun) if _SOURCES else f"<pre>{escape(repr(noun))}</pre>"
