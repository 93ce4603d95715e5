"""Make the networks of `tracker/landmarks/data` from the wheel that holds the originals.

    pip install onnx==1.23.2 tflite==2.18.0
    pip download mediapipe==0.10.21 --no-deps --only-binary=:all: --platform manylinux_2_28_x86_64 --python-version 3.11
    python scripts/build_hand_networks.py mediapipe-0.10.21-*.whl

The originals are TensorFlow Lite graphs (channels last, weights of 16 bits that are widened before use). What comes
out are ONNX graphs with the same weights, still of 16 bits, channels first inside; the image goes in with its channels
first too. Outputs keep the originals' layout.
The wheel's hash is checked, and the tests check those of the networks.

With `--references FILE` (and `pip install ai-edge-litert==2.3.0`) it also writes what the originals say of one image,
for `tests/tracker/landmarks/test_network.py`.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import onnx
import tflite
from onnx import helper, numpy_helper

Array = npt.NDArray[Any]

DATA = Path(__file__).parent.parent / "tracker" / "landmarks" / "data"
WHEEL_SHA256 = "05dc4a9e593655a79558d05d6227d31018c2537a4bd3362b51e230cf22aecfe3"
LICENSE_FILE = "mediapipe-0.10.21.dist-info/LICENSE"
NETWORKS = {
    "palms": "mediapipe/modules/palm_detection/palm_detection_full.tflite",
    "landmarks": "mediapipe/modules/hand_landmark/hand_landmark_full.tflite",
}
OUTPUTS = {"palms": ("boxes", "scores"), "landmarks": ("points", "presence", "side", "points_3d")}
OPSET = 13
TYPES = {
    tflite.TensorType.FLOAT32: np.float32,
    tflite.TensorType.FLOAT16: np.float16,
    tflite.TensorType.INT32: np.int32,
}
FUSED = {1: "Relu", 3: "Relu6"}
"""Activations that are part of an operator, as `tflite.ActivationFunctionType` numbers them."""


class Graph:
    """An ONNX graph that grows operator by operator."""

    def __init__(self, content: bytes) -> None:
        self.model = tflite.Model.GetRootAsModel(content, 0)
        self.source = self.model.Subgraphs(0)
        self.nodes: list[Any] = []
        self.constants: dict[str, Array] = {}
        self.names: dict[int, str] = {}
        self.widened: dict[int, int] = {}

    def shape(self, tensor: int) -> list[int]:
        return [int(size) for size in self.source.Tensors(tensor).ShapeAsNumpy()]

    def value(self, tensor: int) -> Array:
        """Of a constant, as it is stored; weights stay at 16 bits."""
        tensor = self.widened.get(tensor, tensor)
        content = self.model.Buffers(self.source.Tensors(tensor).Buffer()).DataAsNumpy()
        return content.view(TYPES[self.source.Tensors(tensor).Type()]).reshape(self.shape(tensor))

    def constant(self, value: Array) -> str:
        """Name of a constant; one of 16 bits is widened by the graph itself."""
        name = f"c{len(self.constants)}"
        self.constants[name] = value
        if value.dtype != np.float16:
            return name
        return self.node("Cast", [name], to=onnx.TensorProto.FLOAT)

    def node(self, kind: str, inputs: list[str], **attributes: Any) -> str:
        name = f"t{len(self.nodes)}"
        self.nodes.append(helper.make_node(kind, inputs, [name], **attributes))
        return name

    def activate(self, name: str, fused: int) -> str:
        if fused == 0:
            return name
        if FUSED[fused] == "Relu":
            return self.node("Relu", [name])
        return self.node("Clip", [name, self.constant(np.float32(0.0)), self.constant(np.float32(6.0))])


def convert(content: bytes, outputs: tuple[str, ...]) -> bytes:
    """The ONNX file of a TensorFlow Lite file."""
    graph = Graph(content)
    source = graph.source
    kinds = {number: name for name, number in vars(tflite.BuiltinOperator).items() if isinstance(number, int)}
    (first,) = source.InputsAsNumpy()
    _, height, width, channels = graph.shape(first)
    graph.names[first] = "image"
    for index in range(source.OperatorsLength()):
        operator = source.Operators(index)
        kind = kinds[graph.model.OperatorCodes(operator.OpcodeIndex()).BuiltinCode()]
        ins, (out,) = [int(tensor) for tensor in operator.InputsAsNumpy()], operator.OutputsAsNumpy()
        if kind == "DEQUANTIZE":
            graph.widened[out] = ins[0]
            continue
        graph.names[out] = CONVERTERS[kind](graph, operator, ins, int(out))
    wanted = [int(tensor) for tensor in source.OutputsAsNumpy()]
    for tensor, name in zip(wanted, outputs, strict=True):
        graph.nodes.append(helper.make_node("Identity", [graph.names[tensor]], [name]))
    floats = onnx.TensorProto.FLOAT
    made = helper.make_graph(
        graph.nodes,
        "hand",
        [helper.make_tensor_value_info("image", floats, [1, channels, height, width])],
        [helper.make_tensor_value_info(n, floats, graph.shape(t)) for t, n in zip(wanted, outputs, strict=True)],
        [numpy_helper.from_array(np.ascontiguousarray(value), name) for name, value in graph.constants.items()],
    )
    model = helper.make_model(
        made, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=8, producer_name="handloom"
    )
    onnx.checker.check_model(model, full_check=True)
    return model.SerializeToString(deterministic=True)


def _options(operator: Any, kind: type) -> Any:
    options = kind()
    table = operator.BuiltinOptions()
    options.Init(table.Bytes, table.Pos)
    return options


def _pads(size: list[int], kernel: list[int], strides: list[int], padding: int) -> list[int]:
    """Of [top, left, bottom, right], as `SAME` (0) has it: what is odd comes after."""
    if padding != 0:
        return [0, 0, 0, 0]
    total = [max((-(-n // s) - 1) * s + k - n, 0) for n, k, s in zip(size, kernel, strides, strict=True)]
    return [t // 2 for t in total] + [t - t // 2 for t in total]


def _convolve(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    is_depthwise = graph.value(ins[1]).shape[0] == 1 and graph.shape(out)[3] == graph.value(ins[1]).shape[3]
    is_depthwise = is_depthwise and operator.BuiltinOptionsType() == tflite.BuiltinOptions.DepthwiseConv2DOptions
    options = _options(operator, tflite.DepthwiseConv2DOptions if is_depthwise else tflite.Conv2DOptions)
    weights = graph.value(ins[1]).transpose((3, 0, 1, 2) if is_depthwise else (0, 3, 1, 2))
    strides, kernel = [options.StrideH(), options.StrideW()], list(weights.shape[2:])
    name = graph.node(
        "Conv",
        [graph.names[ins[0]], graph.constant(weights), graph.constant(graph.value(ins[2]))],
        kernel_shape=kernel,
        strides=strides,
        pads=_pads(graph.shape(ins[0])[1:3], kernel, strides, options.Padding()),
        group=graph.shape(ins[0])[3] if is_depthwise else 1,
    )
    return graph.activate(name, options.FusedActivationFunction())


def _pool(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    options = _options(operator, tflite.Pool2DOptions)
    kernel, strides = [options.FilterHeight(), options.FilterWidth()], [options.StrideH(), options.StrideW()]
    pads = _pads(graph.shape(ins[0])[1:3], kernel, strides, options.Padding())
    return graph.node("MaxPool", [graph.names[ins[0]]], kernel_shape=kernel, strides=strides, pads=pads)


def _add(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    name = graph.node("Add", [graph.names[tensor] for tensor in ins])
    return graph.activate(name, _options(operator, tflite.AddOptions).FusedActivationFunction())


def _bend(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    slopes = graph.value(ins[1]).reshape(-1, 1, 1).astype(np.float32)  # OpenCV takes no slopes that are widened later
    return graph.node("PRelu", [graph.names[ins[0]], graph.constant(slopes)])


def _pad(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    before, after = graph.value(ins[1])[[0, 3, 1, 2]].T
    return graph.node("Pad", [graph.names[ins[0]], graph.constant(np.concatenate([before, after]).astype(np.int64))])


def _resize(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    options = _options(operator, tflite.ResizeBilinearOptions)
    mode = "align_corners" if options.AlignCorners() else "half_pixel" if options.HalfPixelCenters() else "asymmetric"
    (_, rows, columns, _), (_, to_rows, to_columns, _) = graph.shape(ins[0]), graph.shape(out)
    scales = graph.constant(np.array([1, 1, to_rows / rows, to_columns / columns], dtype=np.float32))
    return graph.node("Resize", [graph.names[ins[0]], "", scales], mode="linear", coordinate_transformation_mode=mode)


def _reshape(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    name = graph.node("Transpose", [graph.names[ins[0]]], perm=[0, 2, 3, 1])
    return graph.node("Reshape", [name, graph.constant(np.array(graph.shape(out), dtype=np.int64))])


def _join(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    assert len(graph.shape(out)) == 3
    return graph.node("Concat", [graph.names[tensor] for tensor in ins], axis=1)


def _average(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    name = graph.node("GlobalAveragePool", [graph.names[ins[0]]])
    return graph.node("Flatten", [name], axis=1)


def _multiply(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    weights, offset = (graph.constant(graph.value(tensor)) for tensor in ins[1:])
    name = graph.node("Gemm", [graph.names[ins[0]], weights, offset], transB=1)
    return graph.activate(name, _options(operator, tflite.FullyConnectedOptions).FusedActivationFunction())


def _squash(graph: Graph, operator: Any, ins: list[int], out: int) -> str:
    return graph.node("Sigmoid", [graph.names[ins[0]]])


CONVERTERS = {
    "CONV_2D": _convolve,
    "DEPTHWISE_CONV_2D": _convolve,
    "MAX_POOL_2D": _pool,
    "ADD": _add,
    "PRELU": _bend,
    "PAD": _pad,
    "RESIZE_BILINEAR": _resize,
    "RESHAPE": _reshape,
    "CONCATENATION": _join,
    "MEAN": _average,
    "FULLY_CONNECTED": _multiply,
    "LOGISTIC": _squash,
}


def describe_original(content: bytes, outputs: tuple[str, ...]) -> dict[str, Array]:
    """An image (1, 3, H, W) of noise that is smooth, and what a TensorFlow Lite file makes of it."""
    from ai_edge_litert.interpreter import Interpreter

    original = Interpreter(model_content=content, num_threads=1)
    original.allocate_tensors()
    place = original.get_input_details()[0]
    size = int(place["shape"][1])
    coarse = np.random.default_rng(0).random((1, 3, size // 16, size // 16), dtype=np.float32)
    image = np.repeat(np.repeat(coarse, 16, axis=2), 16, axis=3)
    original.set_tensor(place["index"], np.ascontiguousarray(image.transpose(0, 2, 3, 1)))
    original.invoke()
    told = sorted(original.get_output_details(), key=lambda output: output["name"])
    values = {name: original.get_tensor(one["index"]) for name, one in zip(outputs, told, strict=True)}
    return {"image": coarse, **values}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wheel", type=Path, help="mediapipe-0.10.21-cp311-cp311-manylinux_2_28_x86_64.whl")
    parser.add_argument("--references", type=Path, help="write what the originals say of one image, npz")
    args = parser.parse_args()
    wheel, references = args.wheel, {}
    if hashlib.sha256(wheel.read_bytes()).hexdigest() != WHEEL_SHA256:
        sys.exit(f"{wheel} is not the wheel that the networks were made from (SHA-256 {WHEEL_SHA256}).")
    DATA.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(wheel) as archive:
        (DATA / "LICENSE").write_bytes(archive.read(LICENSE_FILE))
        for name, path in NETWORKS.items():
            content = convert(archive.read(path), OUTPUTS[name])
            (DATA / f"{name}.onnx").write_bytes(content)
            if args.references:
                said = describe_original(archive.read(path), OUTPUTS[name])
                references |= {f"{name}/{key}": value for key, value in said.items()}
            print(f"{hashlib.sha256(content).hexdigest()}  {name}.onnx  {len(content):,} bytes")
    if args.references:
        np.savez_compressed(args.references, **references)


if __name__ == "__main__":
    main()
