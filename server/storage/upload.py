"""A multipart upload written to disk as it arrives. The names in it are the client's: checked, never trusted."""

from __future__ import annotations

import errno
import unicodedata
import uuid
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO, TypeVar

from anyio import CancelScope
from python_multipart.exceptions import MultipartParseError
from python_multipart.multipart import MultipartParser, parse_options_header
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request

from server.errors import InvalidError, StudioError, TooLargeError
from server.storage.storage import Storage
from tracker.capture import find_path_fault

MAX_FIELD_BYTES = 64 * 1024
MAX_DEPTH = 12
Result = TypeVar("Result")
WRITE_BYTES = 1024 * 1024


class DiskFullError(StudioError):
    """There is no room left."""

    status_code = 507


@dataclass
class Upload:
    """What has arrived so far.

    Attributes:
        folder: The files go below it.
        max_files: Most files.
        max_bytes: Most bytes of all files together.
        names: Relative names of the files.
        fields: The form's other fields.
        byte_count: Of all files.
    """

    folder: Path
    max_files: int
    max_bytes: int
    names: list[str] = field(default_factory=list)
    fields: dict[str, str] = field(default_factory=dict)
    byte_count: int = 0

    def begin_file(self, name: str) -> BinaryIO:
        """Open a file for a name that the client gave."""
        if fault := find_path_fault(name):
            raise InvalidError(f"The file name {name[:200]!r} {fault}. Rename the file and upload again.")
        if name.count("/") > MAX_DEPTH:
            raise InvalidError(f"{name[:200]!r} lies more than {MAX_DEPTH} folders deep.")
        if len(self.names) >= self.max_files:
            raise TooLargeError(f"More than {self.max_files} files; HANDLOOM_MAX_UPLOAD_FILES sets the limit.")
        plain = unicodedata.normalize("NFKC", name).casefold()
        if plain in self._plain_names:
            raise InvalidError(f"Two files are named {name[:200]!r} (upper and lower case taken as one).")
        self._plain_names.add(plain)
        path = self.folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            file = path.open("xb")
        except (FileExistsError, NotADirectoryError):
            raise InvalidError(f"{name[:200]!r} is a file and a folder.") from None
        self.names.append(name)
        return file

    def count(self, more: int) -> None:
        """Note that so many bytes of files are to be written."""
        self.byte_count += more
        if self.byte_count > self.max_bytes:
            raise TooLargeError(f"More than {self.max_bytes} bytes; HANDLOOM_MAX_UPLOAD_BYTES sets the limit.")

    def __post_init__(self) -> None:
        self._plain_names: set[str] = set()


class UploadParser:
    """Takes the body of a request piece by piece."""

    def __init__(self, content_type: str, upload: Upload) -> None:
        kind, options = parse_options_header(content_type)
        if kind != b"multipart/form-data" or not options.get(b"boundary"):
            raise InvalidError(f"The upload is of type {content_type[:100]!r}; needed multipart/form-data.")
        self.upload = upload
        self.is_whole = False
        self._file: BinaryIO | None = None
        self._field: tuple[str, bytearray] | None = None
        self._header, self._value = bytearray(), bytearray()
        self._disposition = b""
        try:
            self._parser = MultipartParser(
                options[b"boundary"],
                {
                    "on_part_begin": self._begin_part,
                    "on_header_field": lambda data, start, end: self._header.extend(data[start:end]),
                    "on_header_value": lambda data, start, end: self._value.extend(data[start:end]),
                    "on_header_end": self._end_header,
                    "on_headers_finished": self._begin_data,
                    "on_part_data": self._write,
                    "on_part_end": self._end_part,
                    "on_end": self._end,
                },
            )
        except (ValueError, MultipartParseError) as fault:
            raise InvalidError(f"The upload cannot be read: {fault}.") from None

    def feed(self, data: bytes) -> None:
        """The next piece."""
        try:
            self._parser.write(data)
        except MultipartParseError as fault:
            raise InvalidError(f"The upload is damaged: {fault}. Try again.") from None
        except OSError as fault:
            if fault.errno in (errno.ENOSPC, errno.EDQUOT):
                raise DiskFullError("The disk of the studio is full; nothing was kept of the upload.") from None
            raise

    def finish(self) -> None:
        """No more will come."""
        self.close()
        if not self.is_whole:
            raise InvalidError("The upload ended in the middle; nothing was kept of it. Try again.")

    def close(self) -> None:
        """Let go of an open file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _begin_part(self) -> None:
        self._disposition = b""

    def _end_header(self) -> None:
        if bytes(self._header).lower() == b"content-disposition":
            self._disposition = bytes(self._value)
        self._header.clear()
        self._value.clear()

    def _begin_data(self) -> None:
        _, options = parse_options_header(self._disposition)
        if b"filename" in options:
            self._file = self.upload.begin_file(_decode(options[b"filename"]))
        elif len(self.upload.fields) < 16:
            self._field = (_decode(options.get(b"name", b"")), bytearray())
        else:
            raise InvalidError("The form has more than 16 fields beside its files.")

    def _write(self, data: bytes, start: int, end: int) -> None:
        if self._file is not None:
            self.upload.count(end - start)
            self._file.write(memoryview(data)[start:end])
        elif self._field is not None:
            self._field[1].extend(data[start:end])
            if len(self._field[1]) > MAX_FIELD_BYTES:
                raise TooLargeError(f"The form's field {self._field[0][:80]!r} has more than {MAX_FIELD_BYTES} bytes.")

    def _end_part(self) -> None:
        self.close()
        if self._field is not None:
            self.upload.fields[self._field[0]] = _decode(bytes(self._field[1]))
            self._field = None

    def _end(self) -> None:
        self.is_whole = True


def _decode(data: bytes) -> str:
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise InvalidError(f"The upload holds the name {data[:80]!r}, which is not UTF-8.") from None


async def receive_upload(stream: AsyncIterator[bytes], content_type: str, upload: Upload) -> None:
    """Write a whole upload, in threads so that the studio goes on answering; raises when it is not whole."""
    parser = UploadParser(content_type, upload)
    pieces: list[bytes] = []
    try:
        async for piece in stream:
            pieces.append(piece)
            if sum(map(len, pieces)) >= WRITE_BYTES:
                await run_in_threadpool(parser.feed, b"".join(pieces))
                pieces.clear()
        await run_in_threadpool(parser.feed, b"".join(pieces))
        await run_in_threadpool(parser.finish)
    finally:
        parser.close()


@dataclass(frozen=True)
class UploadLimits:
    """What one upload may bring."""

    files: int
    total_bytes: int


async def work_on_upload(
    request: Request, storage: Storage, area: str, limits: UploadLimits, work: Callable[[Path, Upload], Result]
) -> Result:
    """Receive the files into a folder of their own, work on them in a thread, and remove them whatever happens.

    Args:
        request: With a body of `multipart/form-data`.
        storage: Where the folder is made.
        area: Below which.
        limits: More is refused.
        work: Takes the folder, and the upload with its fields; gives the answer.
    """
    length = request.headers.get("content-length", "")
    if length.isdecimal() and int(length) > limits.total_bytes + 2**20:
        raise TooLargeError(f"The upload has {length} bytes; allowed are {limits.total_bytes}.")
    id_ = uuid.uuid4()
    folder = storage.folder(area, id_)
    try:
        await run_in_threadpool(folder.mkdir)
        upload = Upload(folder, limits.files, limits.total_bytes)
        await receive_upload(request.stream(), request.headers.get("content-type", ""), upload)
        if not upload.names:
            raise InvalidError("The upload holds no files. Choose some, or a zip of them.")
        return await run_in_threadpool(work, folder, upload)
    finally:
        with CancelScope(shield=True):
            await run_in_threadpool(storage.remove, area, id_)
