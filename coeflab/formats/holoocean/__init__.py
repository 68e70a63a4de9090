"""HoloOcean."""
