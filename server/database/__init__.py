"""Tables, engine, sessions and migrations."""

from server.database.base import Base, UtcDateTime, utc_now
from server.database.database import Database
from server.database.session import Admission, AdmissionDep, DatabaseDep, SessionDep

__all__ = ["Admission", "AdmissionDep", "Base", "Database", "DatabaseDep", "SessionDep", "UtcDateTime", "utc_now"]
