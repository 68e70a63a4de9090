"""x"""
MADE, PLANNED = "mesh.json", "planned.json"
