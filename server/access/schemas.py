"""Accounts as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StrictBool

from server.access.models import Role
from server.database.numbers import Number


class MyAccount(BaseModel):
    """Who I am."""

    model_config = ConfigDict(from_attributes=True)

    id: uuid.UUID
    name: str
    role: Role
    revision: int
    preferences: dict[str, Any] = Field(description="Of the browser app, such as keys that were put elsewhere.")
    is_login_needed: bool = Field(description="False where the studio is for one person at this machine only.")
    may_write: bool = Field(description="False for a token that may only read.")
    by_token: bool = Field(description="Whether the request came with a token: a script, not a person.")


def _refuse_nul(text: str) -> str:
    if "\0" in text:
        raise ValueError("the character U+0000 cannot be kept")
    return text


Name = Annotated[str, Field(min_length=1, max_length=200), AfterValidator(_refuse_nul)]
Password = Annotated[str, Field(max_length=1000, description="10 to 200 characters; a few words in a row do.")]


NewPassword = Annotated[Password, Field(json_schema_extra={"minLength": 10, "maxLength": 200})]


class LoginIn(BaseModel):
    """A name and a password."""

    name: Name
    password: Password


class CodeIn(BaseModel):
    """A one-time code and the password that it sets."""

    code: Annotated[str, Field(min_length=1, max_length=200)]
    password: NewPassword


class PasswordIn(BaseModel):
    """A new password of one's own."""

    current: Annotated[str, Field(max_length=1000, description="Empty where there is none yet.")] = ""
    new: NewPassword


class LoginOut(BaseModel):
    """A browser in which I am logged in."""

    model_config = ConfigDict(from_attributes=True, title="Login")

    id: uuid.UUID
    user_agent: str
    created_at: datetime
    last_seen_at: datetime
    expires_at: datetime
    is_this: bool = Field(default=False, description="Whether the request came from it.")


class TokenIn(BaseModel):
    """A token to be made."""

    name: Name
    may_write: StrictBool = Field(default=False, description="False: it may only read.")
    days: Annotated[Number, Field(gt=0, le=3650)] | None = Field(default=90, description="null: never expires.")


class TokenOut(BaseModel):
    """A way in for scripts."""

    model_config = ConfigDict(from_attributes=True, title="Token")

    id: uuid.UUID
    name: str
    may_write: bool
    created_at: datetime
    expires_at: datetime | None
    last_used_at: datetime | None


class NewToken(TokenOut):
    """A token with its secret, which is shown this once."""

    model_config = ConfigDict(from_attributes=True, title="NewToken")

    secret: str


class PersonIn(BaseModel):
    """An account to be added."""

    name: Name
    role: Role = "annotator"


class PersonPatch(BaseModel):
    """What is to be changed of an account."""

    role: Role | None = None
    is_disabled: StrictBool | None = None


class PersonOut(BaseModel):
    """Somebody, as leads see them."""

    model_config = ConfigDict(title="Person")

    id: uuid.UUID
    name: str
    role: Role
    revision: int
    created_at: datetime
    last_seen_at: datetime | None = Field(description="In a browser that is still logged in.")
    has_password: bool
    is_disabled: bool
    is_local: bool = Field(description="Whoever sits at the studio's machine; nobody manages it.")
    may_manage: bool = Field(description="Whether you may.")


class CodeOut(BaseModel):
    """A one-time code with which somebody sets their password; it is shown this once."""

    code: str
    expires_at: datetime


class PersonAdded(BaseModel):
    """A new account and the code with which its password is set."""

    person: PersonOut
    code: CodeOut


class AuditLine(BaseModel):
    """One thing that somebody did."""

    model_config = ConfigDict(title="AuditLine")

    id: uuid.UUID
    time: datetime
    account_id: uuid.UUID | None
    account: str | None = Field(description="Name; null is the command line, or somebody not logged in.")
    act: str
    subject: str
    subject_id: uuid.UUID | None
    detail: dict[str, Any]
