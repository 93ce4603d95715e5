"""Labels in the formats of others: one file per format, each with its writer, its reader and its conventions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.label_formats.formats import LABEL_FORMATS, export_labels, import_labels
    from tracker.label_formats.image_names import list_image_names
    from tracker.label_formats.label_files import pack_files, read_label_files, save_label_files
    from tracker.label_formats.label_set import ExportedLabels, ImportedLabels, ImportHints, LabelSet
    from tracker.label_formats.orders import JOINT_ORDERS

__getattr__, __dir__ = offer(__name__)
