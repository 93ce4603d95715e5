"""A neural network in an ONNX file, run on the processor."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float32]
Run = Callable[[Array], dict[str, Array]]

DATA = Path(__file__).parent / "data"


def load_network(name: str, outputs: tuple[str, ...], threads: int = 1) -> Run:
    """A network of `tracker/landmarks/data`.

    onnxruntime runs it where it is installed (the extra `handloom[fast]`), else OpenCV, which takes two to four times
    as long.

    Args:
        name: Of the file, without its ending.
        outputs: Names of what it computes.
        threads: For onnxruntime; OpenCV takes those of `cv2.setNumThreads`.

    Returns:
        From an image (1, 3, H, W), red green blue in 0 to 1, to each output.
    """
    path = DATA / f"{name}.onnx"
    try:
        onnxruntime = import_module("onnxruntime")
    except ImportError:
        return _run_by_opencv(path, outputs)
    return _run_by_onnxruntime(onnxruntime, path, outputs, threads)


def _run_by_onnxruntime(onnxruntime: Any, path: Path, outputs: tuple[str, ...], threads: int) -> Run:
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    session = onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])
    return lambda image: dict(zip(outputs, session.run(list(outputs), {"image": image}), strict=True))


def _run_by_opencv(path: Path, outputs: tuple[str, ...]) -> Run:
    network = cv2.dnn.readNetFromONNX(str(path))

    def run(image: Array) -> dict[str, Array]:
        network.setInput(image, "image")
        told = network.forward(list(outputs))
        return {name: np.asarray(value, dtype=np.float32) for name, value in zip(outputs, told, strict=True)}

    return run
