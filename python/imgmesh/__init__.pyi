import builtins
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final, Literal, TypeAlias, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "NO_FACE", "ArgumentError", "BadFileError", "Comparison", "Error", "FileError", "Image", "InternalError", "Level",
    "Mesh", "OutOfMemoryError", "Segmentation", "UnsupportedError", "Warning", "__version__", "build",
    "build_parameters", "compare", "decode", "encode", "read", "read_image", "write_image",
]

_Path: TypeAlias = str | bytes | os.PathLike[str] | os.PathLike[bytes]
_Progress: TypeAlias = Callable[[float, str], object]
_Draco: TypeAlias = Literal["edgebreaker", "sequential", "none"]
_Mode: TypeAlias = Literal["map", "gouraud", "wire", "patches", "flat", "visits"]
_ColorSpace: TypeAlias = Literal["sRGB", "linear", "Rec709", "Gamma2.2", "AdobeRGB", "DisplayP3"]
_NonFinite: TypeAlias = Literal["refuse", "zero", "nearest"]
_Dtype: TypeAlias = Literal["uint8", "uint16", "float16", "float32"]
_Size: TypeAlias = tuple[int, int]
_Place: TypeAlias = tuple[int, int]
_Edits: TypeAlias = _Path | Mapping[str, Any] | Sequence[Mapping[str, Any]]
_ImageLike: TypeAlias = _Path | Image | ArrayLike

NO_FACE: Final[int]
__version__: Final[str]

class Error(Exception): ...
class ArgumentError(Error, ValueError): ...
class FileError(Error, OSError): ...
class BadFileError(Error, ValueError): ...
class UnsupportedError(Error, ValueError): ...
class OutOfMemoryError(Error, MemoryError): ...
class InternalError(Error, RuntimeError): ...
class Warning(UserWarning): ...

@final
class Image:
    def __init__(
        self,
        array: ArrayLike,
        *,
        color_space: _ColorSpace | None = None,
        channel_names: Sequence[str] = ...,
        values: bool = False,
    ) -> None: ...
    def __array__(self, dtype: Any = None) -> NDArray[Any]: ...
    @property
    def array(self) -> NDArray[Any]: ...
    @property
    def samples(self) -> NDArray[np.float32]: ...
    @property
    def mask(self) -> NDArray[np.bool_] | None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def shape(self) -> tuple[int, ...]: ...
    @property
    def dtype(self) -> np.dtype[Any]: ...
    @property
    def channel_names(self) -> tuple[str, ...]: ...
    @property
    def color_space(self) -> str: ...
    @property
    def metadata(self) -> dict[str, str | float | tuple[float, ...]]: ...

class _Arrays:
    @property
    def vertices(self) -> NDArray[np.float32]: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    @property
    def features(self) -> NDArray[np.float32]: ...
    @property
    def colors(self) -> NDArray[np.float32] | None: ...
    @property
    def face_ids(self) -> NDArray[np.uint32]: ...
    @property
    def barycentrics(self) -> NDArray[np.float32]: ...
    @property
    def mask(self) -> NDArray[np.bool_]: ...

@final
class Level(_Arrays):
    @property
    def index(self) -> int: ...
    @property
    def error(self) -> float: ...

class _LevelReport(TypedDict):
    map_rms: float
    gouraud_rms: float
    channel_rms: dict[str, float]
    position_step: float
    fine_vertices: int
    color_levels: int

class _Report(TypedDict):
    pixels: int
    clipped_samples: int
    collapses: int
    levels: list[_LevelReport]
    missed: list[str]
    seconds: dict[str, float]

class _Written(TypedDict):
    files: list[str]
    mesh_bytes: int
    layer_bytes: int

class _Facts(TypedDict):
    version: str
    draco: str
    layers: str
    files: list[str]
    total_bytes: int
    mesh_bytes: int
    layer_bytes: int
    texture_bytes: int

@final
class Mesh(_Arrays):
    @property
    def levels(self) -> tuple[Level, ...]: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def channel_names(self) -> tuple[str, ...]: ...
    @property
    def color_space(self) -> str: ...
    @property
    def dtype(self) -> np.dtype[Any]: ...
    @property
    def has_mask(self) -> bool: ...
    @property
    def is_hdr(self) -> bool: ...
    @property
    def visits(self) -> NDArray[np.uint32] | None: ...
    @property
    def parameters(self) -> dict[str, bool | int | float | str]: ...
    @property
    def metadata(self) -> dict[str, str | float | tuple[float, ...]]: ...
    @property
    def generator(self) -> str: ...
    @property
    def report(self) -> _Report | None: ...
    @property
    def facts(self) -> _Facts | None: ...
    def write(
        self,
        path: _Path,
        *,
        draco: _Draco | None = None,
        layers: Literal["exr", "compact"] | None = None,
        no_map: bool = False,
        overwrite: bool = True,
        threads: int | None = None,
    ) -> _Written: ...
    def reconstruct(
        self,
        mode: _Mode = "map",
        scale: float = 1,
        level: int = 0,
        *,
        all_channels: bool = False,
        threads: int | None = None,
    ) -> Image: ...
    def smooth(
        self,
        strength: float = 8,
        *,
        image: _ImageLike | None = None,
        level: int = 0,
        progress: _Progress | None = None,
        threads: int | None = None,
    ) -> Image: ...
    def svg(self, mode: Literal["wire", "flat"] = "wire", level: int = 0) -> str: ...
    def segment(
        self,
        *,
        threshold: float | None = None,
        segments: int | Literal["auto"] | None = None,
        superpixels: int | None = None,
        min_size: int = 1,
        compactness: float | None = None,
        distance: Literal["contour", "paper"] | None = None,
        quality: Literal["fast", "default"] | None = None,
        level: int = 0,
        image: _ImageLike | None = None,
        strict: bool = False,
        progress: _Progress | None = None,
        threads: int | None = None,
    ) -> Segmentation: ...
    def warp(
        self,
        image: _ImageLike,
        edits: _Edits | None = None,
        *,
        size: _Size | None = None,
        retarget: _Size | None = None,
        threads: int | None = None,
    ) -> Image: ...
    def warp_mesh(self, edits: _Edits, *, threads: int | None = None) -> Mesh: ...
    def displacement(self, edits: _Edits, *, threads: int | None = None) -> NDArray[np.float32]: ...
    def st_map(
        self,
        edits: _Edits | None = None,
        *,
        image: _ImageLike | None = None,
        size: _Size | None = None,
        retarget: _Size | None = None,
        threads: int | None = None,
    ) -> NDArray[np.float32]: ...

class _Region(TypedDict):
    pixels: int
    luv: tuple[float, float, float]
    box: tuple[int, int, int, int]
    neighbors: dict[int, int]

@final
class Segmentation:
    @property
    def labels(self) -> NDArray[np.uint32]: ...
    @property
    def count(self) -> int: ...
    @property
    def regions(self) -> list[_Region]: ...
    @property
    def missed(self) -> str: ...
    def flat(self) -> Image: ...
    def colors(self) -> Image: ...
    def svg(self, tolerance: float = 0.5) -> str: ...
    def mask(
        self, *, keep: Sequence[_Place | Sequence[_Place]] = ..., drop: Sequence[_Place | Sequence[_Place]] = ...
    ) -> NDArray[np.bool_]: ...
    def outlines(self) -> Image: ...
    def contours(self) -> NDArray[np.float32]: ...
    def write(self, path: _Path, *, overwrite: bool = True) -> None: ...

@final
class Comparison:
    @property
    def pixels(self) -> int: ...
    @property
    def in_one_only(self) -> int: ...
    @property
    def rms_luv(self) -> float: ...
    @property
    def max_luv(self) -> float: ...
    @property
    def rms_visible(self) -> float: ...
    @property
    def max_visible(self) -> float: ...
    @property
    def rms_alpha(self) -> float: ...
    @property
    def max_alpha(self) -> float: ...
    @property
    def rms_rgb(self) -> float: ...
    @property
    def max_rgb(self) -> float: ...
    @property
    def psnr(self) -> float: ...
    @property
    def ssim(self) -> float: ...
    @property
    def luv(self) -> NDArray[np.float32]: ...
    @property
    def ciede2000(self) -> NDArray[np.float32]: ...
    @property
    def visible(self) -> NDArray[np.float32]: ...
    @property
    def channels(self) -> dict[str, dict[str, float]]: ...

def build(
    image: _ImageLike,
    *,
    preset: Literal["fast", "default", "best", "max", "small", "fem"] | None = None,
    mask: _ImageLike | None = None,
    alpha: Literal["auto", "keep", "cut", "ignore"] | None = "auto",
    alpha_threshold: float | None = None,
    texture: Literal["png", "jpeg"] | None = None,
    strict: bool | None = False,
    progress: _Progress | None = None,
    threads: int | None = None,
    color_space: _ColorSpace | None = None,
    part: str | None = None,
    layer: str | None = None,
    non_finite: _NonFinite | None = "refuse",
    nodata: float | Literal["none"] | None = None,
    max_pixels: int | None = None,
    channels: Sequence[str] | Mapping[str, float] | None = None,
    values: bool | None = None,
    density: float | None = None,
    vertices: int | None = None,
    faces: int | None = None,
    error: float | None = None,
    rms: float | None = None,
    max_cluster: int | None = None,
    min_quality: float | None = None,
    levels: int | None = None,
    level_faces: Iterable[int] | None = None,
    level_errors: Iterable[float] | None = None,
    metric: Literal["flattened", "hoppe", "garland"] | None = None,
    solver: Literal["svd", "lu", "closed"] | None = None,
    geometry_weight: float | None = None,
    color_weight: float | None = None,
    smoothing: int | None = None,
    quadrics: Literal["accumulated", "rebuilt"] | None = None,
    priority: Literal["increment", "total"] | None = None,
    colors: Literal["fitted", "quadric"] | None = None,
    refine: int | None = None,
    shape_weight: float | None = None,
    exchange: float | None = None,
    anneal: int | None = None,
    objective: Literal["luv", "rgb"] | None = None,
    map: Literal["relaxed", "tracked", "trivial"] | None = None,
    projection_color_weight: float | None = None,
    map_smoothness: float | None = None,
    map_step: Literal["1/32", "1/16", "1/8"] | None = None,
    map_rounds: int | None = None,
    map_rate: float | None = None,
    bary: Literal["half", "float"] | None = None,
    visits: bool | None = None,
    mesh_precision: Literal["exact", "compact"] | None = None,
    position_step: Literal["1/32", "1/16", "1/8", "1/4", "1/2", "1"] | None = None,
    color_levels: int | None = None,
) -> Mesh: ...
def build_parameters() -> list[dict[str, Any]]: ...
def compare(a: _ImageLike | Mesh, b: _ImageLike | Mesh, *, threads: int | None = None) -> Comparison: ...
def decode(data: bytes, *, size: _Size | None = None, threads: int | None = None) -> Image: ...
def encode(
    image: _ImageLike,
    *,
    bytes: int | None = None,
    psnr: float | None = None,
    vertices: int | None = None,
    quality: float | None = None,
    effort: int = 3,
    tune: Literal["psnr", "luma", "ssim"] = "psnr",
    progress: _Progress | None = None,
    threads: int | None = None,
) -> builtins.bytes: ...
def read(path: _Path, *, threads: int | None = None) -> Mesh: ...
def read_image(
    path: _Path,
    *,
    color_space: _ColorSpace | None = None,
    part: str | None = None,
    layer: str | None = None,
    non_finite: _NonFinite | None = "refuse",
    values: bool | None = False,
    nodata: float | Literal["none"] | None = None,
    max_pixels: int | None = None,
) -> Image: ...
def write_image(
    path: _Path,
    image: Image | ArrayLike,
    *,
    dtype: _Dtype | None = None,
    color_space: _ColorSpace | None = None,
    overwrite: bool = True,
) -> None: ...
