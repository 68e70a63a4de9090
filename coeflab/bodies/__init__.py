"""Bodies: shapes, meshes, readers, simplification, added mass."""

from __future__ import annotations
