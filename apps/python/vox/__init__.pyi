from os import PathLike
from typing import Any, Callable, Iterator, Mapping, NamedTuple, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

_Path = Union[str, bytes, PathLike[str], PathLike[bytes]]
_Progress = Callable[[float, str], object]
_Names = Union[str, Sequence[str]]
_Number = Union[float, np.floating[Any], np.integer[Any]]
_Whole = Union[int, np.integer[Any]]
_Vertices = Union[_Path, ArrayLike]
_Labels = Union[ArrayLike, tuple[Sequence[str], ArrayLike]]
_Sets = tuple[list[str], NDArray[np.int64]]
_Faces = Union[ArrayLike, Sequence[Sequence[int]], tuple[ArrayLike, ArrayLike]]
_Voxel = Union[tuple[int, int, int], Sequence[int], NDArray[np.integer[Any]]]

class Error(Exception): ...
class UsageError(Error, ValueError): ...
class InputError(Error, ValueError): ...
class MeshError(InputError): ...
class LimitError(Error): ...
class IoError(Error, OSError): ...
class CheckFailed(Error): ...
class Cancelled(Error): ...
class VoxWarning(UserWarning): ...

class Mesh:
    def __init__(
        self,
        points: ArrayLike,
        faces: _Faces,
        *,
        point_colors: ArrayLike | None = ...,
        face_colors: ArrayLike | None = ...,
        uv: ArrayLike | None = ...,
        smoothing_groups: ArrayLike | None = ...,
        objects: _Labels | None = ...,
        groups: _Labels | None = ...,
        materials: _Labels | None = ...,
        name: str = ...,
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def offsets(self) -> NDArray[np.uint32]: ...
    @property
    def corners(self) -> NDArray[np.uint32]: ...
    @property
    def point_colors(self) -> NDArray[np.float32] | None: ...
    @property
    def face_colors(self) -> NDArray[np.float32] | None: ...
    @property
    def uv(self) -> NDArray[np.float32] | None: ...
    @property
    def smoothing_groups(self) -> NDArray[np.uint32] | None: ...
    @property
    def objects(self) -> _Sets | None: ...
    @property
    def groups(self) -> _Sets | None: ...
    @property
    def materials(self) -> _Sets | None: ...
    def write(self, path: _Path, *, overwrite: bool = ...) -> None: ...

class Scene:
    def __init__(self, meshes: Sequence[Mesh]) -> None: ...
    @property
    def meshes(self) -> list[Mesh]: ...
    @property
    def files(self) -> list[str]: ...

class Transform(NamedTuple):
    voxel_size: tuple[float, float, float]
    origin: tuple[float, float, float]
    def to_world(self, voxels: ArrayLike) -> NDArray[np.float64]: ...
    def to_index(self, positions: ArrayLike) -> NDArray[np.float64]: ...

class Grid:
    @property
    def name(self) -> str: ...
    @property
    def dtype(self) -> np.dtype[Any]: ...
    @property
    def grid_class(self) -> str: ...
    @property
    def active_voxels(self) -> int: ...
    @property
    def bounds(self) -> tuple[tuple[int, int, int], tuple[int, int, int]] | None: ...
    @property
    def transform(self) -> Transform: ...
    @property
    def metadata(self) -> dict[str, bool | int | float | str]: ...
    @property
    def coords(self) -> NDArray[np.int32]: ...
    @property
    def values(self) -> NDArray[Any]: ...
    def to_dense(self, low: _Voxel | None = ..., high: _Voxel | None = ...) -> NDArray[Any]: ...

class Grids(Mapping[str, Grid]):
    def __getitem__(self, name: str) -> Grid: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def write(
        self,
        path: _Path,
        *,
        overwrite: bool = ...,
        compression: str | None = ...,
        progress: _Progress | None = ...,
    ) -> None: ...

def read(path: _Path) -> Any:
    """Mesh, Scene or Grids."""

def convert(
    input: Mesh | Scene | _Path,
    *,
    progress: _Progress | None = ...,
    dim: _Whole | None = ...,
    voxel_size: _Number | None = ...,
    like: _Path | None = ...,
    clip: bool | None = ...,
    bounds: str | Sequence[float] | NDArray[Any] | None = ...,
    scale: _Number | None = ...,
    boundary: str | None = ...,
    interpolate: str | None = ...,
    interpolate_vertices: _Vertices | None = ...,
    crease: str | _Number | None = ...,
    crease_edges: _Vertices | None = ...,
    corner_vertices: _Vertices | None = ...,
    faces: str | None = ...,
    until: _Names | None = ...,
    voxelize: str | None = ...,
    separating: int | str | None = ...,
    weld: _Number | None = ...,
    drop_components: _Names | None = ...,
    strict: bool | None = ...,
    grids: _Names | None = ...,
    texture: str | None = ...,
    part: str | None = ...,
    part_by: str | None = ...,
    split: str | None = ...,
    fill: str | None = ...,
    edge: str | None = ...,
    alpha: str | None = ...,
    gain: _Number | None = ...,
    open_mesh: str | None = ...,
    close: _Whole | None = ...,
    band: str | _Number | Sequence[float] | None = ...,
    tolerance: _Number | None = ...,
    half: bool | None = ...,
    compression: str | None = ...,
    target: str | None = ...,
    up: str | None = ...,
    localize: str | None = ...,
    submesh_faces: _Whole | None = ...,
    verify: bool | None = ...,
    threads: _Whole | None = ...,
    max_memory: int | str | None = ...,
) -> Grids: ...
def subdivide(
    input: Mesh | Scene | _Path,
    *,
    levels: _Whole,
    progress: _Progress | None = ...,
    boundary: str | None = ...,
    interpolate: str | None = ...,
    interpolate_vertices: _Vertices | None = ...,
    crease: str | _Number | None = ...,
    crease_edges: _Vertices | None = ...,
    corner_vertices: _Vertices | None = ...,
    faces: str | None = ...,
    scale: _Number | None = ...,
    weld: _Number | None = ...,
    drop_components: _Names | None = ...,
    strict: bool | None = ...,
    threads: _Whole | None = ...,
    max_memory: int | str | None = ...,
) -> Mesh: ...
def render(
    input: Grids | Mesh | Scene | _Path,
    path: _Path | None = ...,
    *,
    overwrite: bool = ...,
    progress: _Progress | None = ...,
    view: _Names | None = ...,
    up: str | None = ...,
    projection: str | None = ...,
    size: str | None = ...,
    background: str | None = ...,
    shading: str | None = ...,
    samples: _Whole | None = ...,
    occlusion: _Whole | None = ...,
    grid: str | None = ...,
    threshold: _Number | None = ...,
    dim: _Whole | None = ...,
    voxel_size: _Number | None = ...,
    like: _Path | None = ...,
    clip: bool | None = ...,
    bounds: str | Sequence[float] | NDArray[Any] | None = ...,
    scale: _Number | None = ...,
    boundary: str | None = ...,
    interpolate: str | None = ...,
    interpolate_vertices: _Vertices | None = ...,
    crease: str | _Number | None = ...,
    crease_edges: _Vertices | None = ...,
    corner_vertices: _Vertices | None = ...,
    faces: str | None = ...,
    until: _Names | None = ...,
    voxelize: str | None = ...,
    separating: int | str | None = ...,
    weld: _Number | None = ...,
    drop_components: _Names | None = ...,
    strict: bool | None = ...,
    localize: str | None = ...,
    submesh_faces: _Whole | None = ...,
    texture: str | None = ...,
    threads: _Whole | None = ...,
    max_memory: int | str | None = ...,
) -> NDArray[np.uint8]: ...
def info(
    input: Grids | Mesh | Scene | _Path,
    *,
    scale: _Number | None = ...,
    boundary: str | None = ...,
    crease: str | _Number | None = ...,
    crease_edges: _Vertices | None = ...,
    corner_vertices: _Vertices | None = ...,
    faces: str | None = ...,
    weld: _Number | None = ...,
    drop_components: _Names | None = ...,
) -> dict[str, Any]: ...
def diff(
    a: Grids | _Path,
    b: Grids | _Path,
    *,
    overwrite: bool = ...,
    tolerance: _Number | None = ...,
    relative: _Number | None = ...,
    tolerance_voxels: _Number | None = ...,
    grids: _Names | None = ...,
    no_metadata: bool | None = ...,
    junit: _Path | None = ...,
    report: _Path | None = ...,
) -> dict[str, Any]: ...
def check(
    grids: Grids | _Path,
    mesh: Mesh | Scene | _Path | None = ...,
    *,
    overwrite: bool = ...,
    grid: str | None = ...,
    boundary: str | None = ...,
    interpolate: str | None = ...,
    interpolate_vertices: _Vertices | None = ...,
    crease: str | _Number | None = ...,
    crease_edges: _Vertices | None = ...,
    corner_vertices: _Vertices | None = ...,
    faces: str | None = ...,
    until: str | None = ...,
    weld: _Number | None = ...,
    ignore: _Names | None = ...,
    report: _Path | None = ...,
    threads: _Whole | None = ...,
    max_memory: int | str | None = ...,
) -> dict[str, Any]: ...
