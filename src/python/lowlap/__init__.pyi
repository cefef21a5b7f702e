from os import PathLike
from typing import (
    Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union)

import numpy as np
from numpy.typing import ArrayLike, NDArray

Path = Union[str, PathLike[str]]
Words = Union[str, Sequence[str]]
Pair = Tuple[int, int]
Triplet = Tuple[int, int, int]
Doubles = NDArray[np.float64]
Indices = NDArray[np.uint32]
Progress = Callable[[str, int, int], Optional[bool]]
Log = Callable[[str, str], None]

__version__: str

class Error(Exception):
    code: str
    message: str
    file: str
    place: str
    def __init__(
        self, code: str, message: str, file: str = ..., place: str = ...) -> None: ...

# Scenes

class View:
    local_path: str
    filename: str
    width_px: int
    height_px: int
    intrinsic_id: Optional[int]
    pose_id: Optional[int]

class Intrinsic:
    model: str
    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    principal_point_px: Doubles
    distortion: Doubles
    calibration: Doubles
    def project(self, point_in_cam: ArrayLike) -> Doubles: ...
    def bearing(self, pixel_px: ArrayLike) -> Optional[Doubles]: ...

class Pose:
    rotation: Doubles
    center: Doubles
    center_covariance: Optional[Doubles]
    def __init__(self, rotation: ArrayLike, center: ArrayLike) -> None: ...

class ViewFeatures:
    points_px: Doubles
    segments_px: Doubles
    segment_stddevs_px: Doubles
    repeated_points: Indices
    repeated_segments: Indices

class RelativePose:
    views: Pair
    rotation: Doubles
    direction: Doubles
    log10_nfa: float
    covariance: Optional[Doubles]
    point_inliers: Indices
    line_inliers: Indices
    weakness: Optional[str]

class Landmark:
    position: Doubles
    observations: Indices
    pixels_px: Doubles

class LineLandmark:
    start: Doubles
    end: Doubles
    direction: Doubles
    moment: Doubles
    observations: Indices

class KindSupport:
    kind: str
    candidates: int
    inliers: int
    log10_nfa: float
    threshold_px: float
    information_share: float

class RatioMode:
    log_ratio: float
    log10_nfa: float

class ScaleRatio:
    views: Triplet
    verdict: str
    is_meaningful: bool
    log_ratio: float
    stddev: float
    interval: Tuple[float, float]
    log10_nfa: float
    second_mode: Optional[RatioMode]
    kinds: List[KindSupport]
    num_inliers: int
    num_rejected_negative: int
    coplanar_inliers: Indices
    def find_kind(self, kind: str) -> Optional[KindSupport]: ...

class Scene:
    root_path: str
    views: Mapping[int, View]
    intrinsics: Mapping[int, Intrinsic]
    given_intrinsics: Mapping[int, Intrinsic]
    poses: Mapping[int, Pose]
    features: Mapping[int, ViewFeatures]
    relative_poses: Mapping[Pair, RelativePose]
    unrelated_pairs: Indices
    point_tracks: Mapping[int, Indices]
    line_tracks: Mapping[int, Indices]
    structure: Mapping[int, Landmark]
    line_structure: Mapping[int, LineLandmark]
    scale_ratios: List[ScaleRatio]
    coplanar_pairs: Indices
    def find_pose(self, view: int) -> Optional[Pose]: ...
    def find_intrinsic(self, view: int) -> Optional[Intrinsic]: ...
    def image_path(self, view: int) -> str: ...
    def validate(self) -> None: ...
    def without_views(self, views: Sequence[int]) -> Scene: ...
    def write(self, path: Path, format: str = ...) -> List[str]: ...

SceneOrPath = Union[Scene, Path]
Truth = Union[Scene, Path, Dict[int, Pose]]

def read(path: Path, exclude: Sequence[str] = ..., log: Optional[Log] = ...) -> Scene: ...
def measure(
    path: Path, *, matchdir: Path = ..., match_file: Path = ..., images: Path = ...,
    exclude: Words = ..., threads: int = ..., seed: int = ...,
    progress: Optional[Progress] = ..., log: Optional[Log] = ...) -> Scene: ...
def triplets(scene: Scene) -> List[Triplet]: ...
def simulate(
    kind: str = ..., *, views: int = ..., pairs: str = ..., points: int = ...,
    lines: int = ..., trifocal_points: float = ..., trifocal_lines: float = ...,
    noise: float = ..., wrong_points: float = ..., wrong_lines: float = ...,
    wrong_candidates: float = ..., broken_lines: float = ...,
    rotation_noise: float = ..., direction_noise: float = ...,
    pose_noise_of_points: float = ..., wrong_directions: float = ...,
    off_line: float = ..., twin_baseline: float = ..., wall_bulge: float = ...,
    box_offset: float = ..., look_outwards: bool = ..., seed: int = ...) -> Tuple[Scene, Scene]: ...

# Evaluation

class ErrorStatistics:
    count: int
    mean: float
    median: float
    max: float
    rmse: float

class ViewPoseError:
    view: int
    name: str
    position_error: float
    rotation_error_deg: float

class Similarity:
    scale: float
    rotation: Doubles
    translation: Doubles

class PoseEvaluation:
    scope: str
    note: str
    num_total: int
    num_solved: int
    unsolved: List[str]
    without_truth: List[str]
    truth_from_solution: Similarity
    views: List[ViewPoseError]
    position: ErrorStatistics
    rotation_deg: ErrorStatistics

def evaluate(scene: SceneOrPath, truth: Truth) -> PoseEvaluation: ...

# Averaging strategies

class TranslationProblem:
    views: Indices
    rotations: Doubles
    edges: NDArray[np.int64]
    directions: Doubles
    direction_stddevs: Doubles
    ratios: NDArray[np.int64]
    log_ratios: Doubles
    ratio_stddevs: Doubles
    tracks: List[Tuple[NDArray[np.int64], Doubles]]

class TranslationAverager:
    def name(self) -> str: ...
    def solve(
        self, problem: TranslationProblem
    ) -> Union[ArrayLike, Tuple[ArrayLike, Sequence[int]]]: ...
    def needs_tracks(self) -> bool: ...
    def needs(self) -> str: ...

class BuiltInAverager:
    def name(self) -> str: ...
    def solve(
        self, problem: TranslationProblem, *, threads: int = ..., seed: int = ...,
        progress: Optional[Progress] = ..., log: Optional[Log] = ...
    ) -> Tuple[Doubles, List[int]]: ...
    def needs_tracks(self) -> bool: ...
    def needs(self) -> str: ...

Strategy = Union[str, TranslationAverager, BuiltInAverager]

def averager(strategy: str) -> BuiltInAverager: ...
def strategies() -> Dict[str, str]: ...
def translation_problem(
    scene: SceneOrPath, *, with_tracks: bool = ..., threads: int = ..., seed: int = ...,
    progress: Optional[Progress] = ..., log: Optional[Log] = ...
) -> TranslationProblem: ...

# Solving

class StageCost:
    name: str
    wall_s: float
    cpu_s: float

class PairReport:
    views: Pair
    accepted: bool
    no_parallax: bool
    reason: str
    num_point_matches: int
    num_line_matches: int
    num_point_inliers: int
    num_line_inliers: int
    log10_nfa: float

class UnrelatedView:
    view: int
    no_parallax: bool
    reason: str

class OutlierEdge:
    views: Pair
    reason: str
    error_deg: float

class ReliabilityWarning:
    reason: str
    views: List[int]
    against: List[Pair]
    untold: List[Pair]
    missing: List[Pair]
    ratios: List[Triplet]
    share: float

class Contest:
    links: List[Pair]
    contradictions: List[Pair]
    views: List[int]

class ReplacedDirection:
    views: Pair
    error_deg: float

class ReconsideredPose:
    views: Pair
    rotation_deg: float
    gained_digits: float

class KindAdjustment:
    landmarks: int
    observations_used: int
    observations_dropped: int
    observations_surplus: int
    initial_rmse_px: Optional[float]
    final_rmse_px: Optional[float]
    stddev_px: float
    threshold_px: float

class RivalOptimum:
    start: str
    distances: Dict[int, float]

class AdjustmentSummary:
    initial_cost: float
    final_cost: float
    points: KindAdjustment
    lines: KindAdjustment
    coplanar: KindAdjustment
    planes: int
    landmarks_on_planes: int
    directions: int
    rivals: List[RivalOptimum]
    iterations: int
    outlier_rounds: int
    converged: bool

class Solution:
    scene: Scene
    num_views: int
    num_placed: int
    unplaced: List[int]
    components: List[List[int]]
    outlier_edges: List[OutlierEdge]
    kept_outliers: List[OutlierEdge]
    left_out_ratios: List[Triplet]
    replaced_directions: List[ReplacedDirection]
    reconsidered_poses: List[ReconsideredPose]
    untold_edges: List[Pair]
    contests: List[Contest]
    weak_ratios: List[Triplet]
    reliability_warnings: List[ReliabilityWarning]
    is_firm: bool
    warnings: List[str]
    notes: List[str]
    calibration_notes: List[str]
    adjustment: Optional[AdjustmentSummary]
    poses_before_adjustment: Dict[int, Pose]
    evaluation: Optional[PoseEvaluation]
    evaluation_before_adjustment: Optional[PoseEvaluation]
    pairs: List[PairReport]
    unrelated_views: List[UnrelatedView]
    costs: List[StageCost]
    def write(self, folder: Path) -> None: ...

def solve(
    scene: SceneOrPath, *, features: Words = ..., coplanar_points: bool = ...,
    criterion: str = ..., nfa: str = ..., threshold: float = ...,
    adjust_features: Words = ..., coplanar_ties: str = ..., directions: bool = ...,
    principal_point_stddev: float = ..., no_adjust: bool = ..., strategy: Strategy = ...,
    refine_intrinsics: Union[bool, Words] = ..., gt: Truth = ..., output: Path = ...,
    matchdir: Path = ..., match_file: Path = ..., images: Path = ..., exclude: Words = ...,
    threads: int = ..., seed: int = ..., progress: Optional[Progress] = ...,
    log: Optional[Log] = ...) -> Solution: ...
def merge(
    models: Union[SceneOrPath, Sequence[SceneOrPath]], *, scene: SceneOrPath = ...,
    images: Path = ..., intrinsics: Union[None, Path, Scene, ArrayLike] = ...,
    focal: float = ..., matchdir: Path = ..., match_file: Path = ..., pairs: str = ...,
    matcher: str = ..., exclude: Words = ..., two_view: Words = ...,
    max_tilt: float = ..., refine_points: bool = ..., cache: Path = ..., features: Words = ...,
    coplanar_points: bool = ..., criterion: str = ..., nfa: str = ...,
    threshold: float = ..., adjust_features: Words = ..., coplanar_ties: str = ...,
    directions: bool = ..., principal_point_stddev: float = ..., no_adjust: bool = ...,
    strategy: Strategy = ..., refine_intrinsics: Union[bool, Words] = ..., gt: Truth = ...,
    output: Path = ..., threads: int = ..., seed: int = ...,
    progress: Optional[Progress] = ..., log: Optional[Log] = ...) -> Solution: ...
def run(
    images: Path, intrinsics: Union[None, Path, Scene, ArrayLike] = ..., *,
    focal: float = ..., pairs: str = ..., matcher: str = ..., exclude: Words = ...,
    two_view: Words = ..., max_tilt: float = ..., refine_points: bool = ..., cache: Path = ...,
    features: Words = ..., coplanar_points: bool = ..., criterion: str = ...,
    nfa: str = ..., threshold: float = ..., adjust_features: Words = ..., coplanar_ties: str = ...,
    directions: bool = ..., principal_point_stddev: float = ..., no_adjust: bool = ...,
    strategy: Strategy = ..., refine_intrinsics: Union[bool, Words] = ..., gt: Truth = ...,
    output: Path = ..., threads: int = ..., seed: int = ...,
    progress: Optional[Progress] = ..., log: Optional[Log] = ...) -> Solution: ...
def scales(
    scene: SceneOrPath, *, features: Words = ..., coplanar_points: bool = ...,
    criterion: str = ..., nfa: str = ..., threshold: float = ..., matchdir: Path = ...,
    match_file: Path = ..., images: Path = ..., exclude: Words = ..., threads: int = ...,
    seed: int = ..., progress: Optional[Progress] = ..., log: Optional[Log] = ...
) -> List[ScaleRatio]: ...

# Diagnosis

class FloatingPart:
    views: List[int]
    meets_in: Optional[int]
    near_group: int
    near_part: int
    rejected_ratio: Optional[int]

class ScaleArticulation:
    view: int
    parts: List[List[int]]
    ratios: List[int]
    is_weak: bool

class Diagnosis:
    is_firm: bool
    groups: List[List[int]]
    groups_by_directions: List[List[int]]
    floating: List[FloatingPart]
    articulation_views: List[ScaleArticulation]
    weak_ratios: List[int]
    ratios: List[ScaleRatio]
    def to_dict(self) -> Dict[str, Any]: ...

def diagnose(
    scene: SceneOrPath, *, features: Words = ..., coplanar_points: bool = ...,
    criterion: str = ..., nfa: str = ..., threshold: float = ...,
    min_inliers: int = ..., max_log10_nfa: float = ..., max_stddev: float = ...,
    matchdir: Path = ..., match_file: Path = ..., images: Path = ..., exclude: Words = ...,
    threads: int = ..., seed: int = ..., progress: Optional[Progress] = ...,
    log: Optional[Log] = ...) -> Diagnosis: ...

# Comparison

class Consistency:
    direction_deg: ErrorStatistics
    mean_baseline: float
    abs_log_ratio: ErrorStatistics
    num_points: int
    reprojection_rmse_px: float

class SolutionQuality:
    consistency: Consistency
    errors: Optional[PoseEvaluation]
    difference: Optional[ErrorStatistics]

class StrategyResult:
    strategy: str
    failure: Optional[str]
    limit: str
    num_placed: int
    num_components: int
    unplaced: List[int]
    before: SolutionQuality
    after: Optional[SolutionQuality]
    poses_before_adjustment: Dict[int, Pose]
    poses: Dict[int, Pose]
    costs: List[StageCost]

class Comparison:
    results: List[StrategyResult]
    reference: str
    num_edges: int
    num_ratios: int
    def to_csv(self) -> str: ...
    def write(self, folder: Path) -> None: ...

def compare(
    scene: SceneOrPath, truth: Optional[Truth] = ...,
    strategies: Union[None, str, Sequence[Strategy]] = ..., *, reference: str = ...,
    output: Path = ..., features: Words = ..., coplanar_points: bool = ...,
    criterion: str = ..., nfa: str = ..., threshold: float = ...,
    adjust_features: Words = ..., coplanar_ties: str = ..., directions: bool = ...,
    principal_point_stddev: float = ..., no_adjust: bool = ..., matchdir: Path = ...,
    match_file: Path = ..., images: Path = ..., exclude: Words = ..., threads: int = ...,
    seed: int = ..., progress: Optional[Progress] = ...,
    log: Optional[Log] = ...) -> Comparison: ...

# A view graph in memory

class TranslationEstimate:
    ratios: List[ScaleRatio]
    poses: Dict[int, Pose]
    unplaced: List[int]

class TranslationScaleEstimator:
    def __init__(
        self, *, features: Words = ..., coplanar_points: bool = ...,
        criterion: str = ..., nfa: str = ..., threshold: float = ...,
        strategy: Union[str, BuiltInAverager] = ...) -> None: ...
    def add_view(
        self, view: int, calibration_px: ArrayLike, width_px: int, height_px: int,
        points_px: ArrayLike, segments_px: Optional[ArrayLike] = ...) -> None: ...
    def add_relative_pose(
        self, first: int, second: int, rotation: ArrayLike, translation: ArrayLike,
        point_matches: ArrayLike, line_matches: Optional[ArrayLike] = ...) -> None: ...
    def set_rotation(self, view: int, cam_from_world: ArrayLike) -> None: ...
    def estimate(
        self, *, threads: int = ..., seed: int = ..., progress: Optional[Progress] = ...,
        log: Optional[Log] = ...) -> TranslationEstimate: ...
