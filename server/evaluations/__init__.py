"""How well tracks fit what people annotated."""
