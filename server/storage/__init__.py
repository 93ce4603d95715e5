"""Files of the studio."""

from server.storage.storage import Storage, StorageDep, get_storage, open_storage

__all__ = ["Storage", "StorageDep", "get_storage", "open_storage"]
