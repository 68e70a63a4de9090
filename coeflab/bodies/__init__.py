"""Bodies: shapes, meshes, readers, simplification, added mass."""
