"""How well real recordings are tracked, judged by joints that people marked in them."""
