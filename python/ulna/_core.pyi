"""What the compiled core offers to Python: arrays in, arrays out, mm and rad always.

Nothing here reads files, prints or knows units other than mm and rad; the typed front (`ulna.arm.model` and
above) does that. All functions release the GIL. `UlnaError` carries a message meant for the user.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

F64: TypeAlias = NDArray[np.float64]
I64: TypeAlias = NDArray[np.int64]
Bool: TypeAlias = NDArray[np.bool_]

#: called from the core about ten times a second with (stage, done, total); stage is "fit", "search", "monte carlo", …
Progress: TypeAlias = Callable[[str, int, int], None]

__version__: str

class UlnaError(ValueError):
    """A question that the core cannot answer, in words for the user."""

def simd_level() -> str:
    """Which instruction set the batch kernels run on: "avx512", "avx2", "neon" or "scalar"."""

class _Told(TypedDict, total=False):
    warmth_k: F64 | None
    """(N,) or (N, n) temperature above 20 °C of the links; None: 20 °C."""
    approach: F64 | None
    """(N, n) +1 where the encoder's angle had been rising, -1 falling, 0 or None: nobody knows."""
    payload: F64 | None
    """(N, 4) what was carried: kg, and x, y, z of its centre in the probe's frame, mm; None: nothing."""

class Arm:
    """Geometry of an arm and its probes. Immutable."""

    def __init__(
        self,
        theta0_rad: F64,  # (n,) the last one must be 0: the last joint carries the probe
        alpha_rad: F64,  # (n,) likewise
        a_mm: F64,  # (n,) likewise
        d_mm: F64,  # (n,) likewise; must be 0 where hayati
        beta_rad: F64,  # (n,) likewise; must be 0 where not hayati
        sign: F64,  # (n,) +1 or -1
        hayati: Bool,  # (n,)
        probe_names: Sequence[str],
        tips_mm: F64,  # (P, 3)
        full_last_link: bool = False,  # then the last joint has a link too
    ) -> None: ...
    def with_slides(self, slides_mm: F64) -> Arm:
        """The same arm with joints that slide, (n,) how far from zero at the most, mm; NaN of those that turn."""
    def with_effects(
        self,
        effects: Sequence[tuple[str, Mapping[str, ArrayLike]]],  # kind, and its arrays by name
    ) -> Arm:
        """The same arm with these effects beyond its geometry, in place of those that it had:

        - "encoder-harmonics": orders (K,) ascending from 1, amplitudes_rad (n, K, 2) cosine and sine
        - "backlash": backlash_rad (n,) full width of the hysteresis
        - "link-expansion": expansion_per_k (n,)
        - "compliance": compliance_rad_per_nm (n,), masses_kg (n,) of what moves with each joint, centres_mm (n, 3) in
          the frame after each link, gravity (3,) its direction in the base frame
        """
    @property
    def joints(self) -> int: ...
    @property
    def signs(self) -> F64: ...
    @property
    def probe_names(self) -> list[str]: ...
    @property
    def parameter_names(self) -> list[str]:
        """`joint.1.theta0, joint.1.alpha, joint.1.a, joint.1.d (or .beta) … probe.bent.x, .y, .z`, then of the effects
        `joint.1.c1, joint.1.s1 …`, `joint.1.backlash …`, `joint.1.expansion …`, `joint.1.compliance …`."""
    @property
    def parameter_units(self) -> list[str]:
        """ "rad", "mm", "1/K" or "rad/(N m)" for each of `parameter_names`."""
    @property
    def parameters(self) -> F64: ...
    def with_parameters(self, parameters: F64) -> Arm: ...
    def reach_mm(self, probe: int = 0) -> float:
        """Sum of the lengths of all links and the tip: nothing is farther from the base."""
    def tip(self, q_rad: F64, probe: int | I64 = 0, **told: Unpack[_Told]) -> F64:
        """(N, n) encoder angles → (N, 3) tip positions in the base frame; probe one index or one per row."""
    def tip_plain(self, q_rad: F64, probe: int = 0, **told: Unpack[_Told]) -> F64:
        """The same by frames, one pose at a time: the formula as written, for comparison."""
    def jacobian(self, q_rad: F64, probe: int = 0, **told: Unpack[_Told]) -> F64:
        """(N, n) → (N, 3, parameters): ∂p/∂parameter, mm for a unit of each."""
    def encoder_jacobian(self, q_rad: F64, probe: int = 0, **told: Unpack[_Told]) -> F64:
        """(N, n) → (N, 3, n): ∂p/∂q_i, mm/rad."""
    def tip_covariance(self, q_rad: F64, probe: int, columns: I64, covariance: F64, **told: Unpack[_Told]) -> F64:
        """J C Jᵀ at each pose, (N, 6): xx, xy, xz, yy, yz, zz in mm². columns (k,): which parameters C (k, k) is of."""
    def direction_effect(self, q_rad: F64, probe: int, columns: I64, directions: F64, **told: Unpack[_Told]) -> F64:
        """(N,): how far the tip moves, mm, for the worst of the parameter directions (m, k). Zero: none matters."""
    def pose_for_points(
        self, points_mm: F64, limits_rad: F64, seed: int, probe: int = 0, tries: int = 40, **told: Unpack[_Told]
    ) -> tuple[F64, Bool]:
        """Inverse kinematics: encoder angles (N, n) within limits (n, 2) that put the tip on points (N, 3), with a
        random elbow and wrist per point, reproducible by seed; and whether each was reached (to 1e-9 mm)."""
    def check_jacobian(self, q_rad: F64, probe: int = 0, **told: Unpack[_Told]) -> float:
        """Largest |analytic − numerical| over all entries, relative to the reach: the public derivative checker."""

class LostDirection(TypedDict):
    combination: dict[
        str, float
    ]  # physical units (rad, mm); the largest effect has weight 1; moving along it changes no residual
    cause: str  # "base-frame", "scale", "probe-on-axis", "probe-unused", "joint-still", "parallel-axes",
    # "redundant-link", "temperature-still", "no-moment", "approach-one-sided", "approach-unknown", "coverage"
    because: str
    remedy: str
    frame: bool  # true: a rigid motion of the base frame or such; no length or shape depends on it

class WeakDirection(TypedDict):
    combination: dict[str, float]
    u: float  # standard uncertainty of the combination's leading parameter, in `unit`
    unit: str
    because: str
    remedy: str

class Identifiability:
    @property
    def parameters(self) -> int:
        """Number of free parameters asked about."""
    @property
    def determined(self) -> int: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def singular_values(self) -> list[float]:
        """Of the Jacobian with unit columns, placements eliminated; descending; zeros for vanished columns."""
    @property
    def condition(self) -> float:
        """Smallest kept singular value over the largest."""
    @property
    def lost(self) -> list[LostDirection]: ...
    @property
    def weak(self) -> list[WeakDirection]:
        """Determined, but worse than an arm is known from its drawing (1 mm, 0.01 rad unless said otherwise)."""
    @property
    def from_prior(self) -> list[str]:
        """Free parameters of which the readings say next to nothing: what is known of them is their prior."""
    @property
    def not_determined(self) -> list[str]:
        """Every free parameter that takes part in a lost direction."""

class KindOfArtefact(TypedDict):
    needs: list[str]  # arguments of `Problem.add` that must be given
    takes: list[str]  # that may be given besides; any other is an error
    dimensions: dict[str, tuple[str, bool]]  # unit ("mm" or "1"), and whether it must be stated

def kinds() -> dict[str, KindOfArtefact]:
    """Every kind of artefact that the core knows."""

class Problem:
    """Readings of features of placed artefacts, to be explained by one arm."""

    def __init__(self, arm: Arm, encoder_u_rad: F64 | None = None, seat_u_mm: float | None = None) -> None:
        """Standard deviations of the noise: (n,) per encoder, and of a touch per coordinate. Both None: every reading
        weighs one."""
    def add(
        self,
        kind: str,  # one of `kinds()`
        artefact: str,
        *,
        q_rad: F64,  # (N, n)
        probe: I64,  # (N,) index into the arm's probes
        placement: I64 | None = None,  # (N,) any labels; equal means the same standing. Ignored for frame = "arm"
        feature: I64 | None = None,  # (N,) index into features
        p_rad: F64 | None = None,  # (N, n) a second pose
        measured_mm: F64 | None = None,  # (N,) the length between two poses, or what an instrument says
        features_mm: F64 | None = None,  # (F, 3); a bar has (0,0,0) and (L,0,0); a seat has (0,0,0)
        labels: Sequence[str] | None = None,  # (F,) names of the features; else they are counted from 1
        feature_u_mm: F64 | None = None,  # (F,) standard uncertainty of the coordinates of each
        features_fitted: bool = False,  # whether they may move within that
        frame: str | None = None,  # "free" (None): each placement has an unknown pose; "arm": in the base frame
        dimensions: Sequence[tuple[str, float, float, bool]] = (),  # name, value, standard uncertainty, whether it is
        # an unknown of the fit: within its uncertainty, freely where that is 0
        inside: bool = False,  # whether a hollow is touched
        balls_mm: F64 | None = None,  # (P,) diameter of each probe's ball
        rotation_rad: F64 | None = None,  # (N, 3) rotation vectors of a target, in the frame of who saw it
        rotation_u_rad: F64 | None = None,  # (N,) standard uncertainty of that about each axis
        warmth_k: F64 | None = None,
        approach: F64 | None = None,
        p_approach: F64 | None = None,  # of the second poses
        payload: F64 | None = None,
    ) -> int:
        """Readings of one artefact; returns the group's number. Raises UlnaError for a kind that there is not, and for
        what a kind needs and lacks or has no use for, by name."""
    def add_prior(self, parameter: int, value: float, u: float) -> None:
        """What is known of a parameter beforehand, in its unit; the number is that in `parameter_names`."""
    def set_loss(self, name: str) -> None:
        """ "none", "huber", "cauchy" or "tukey"."""
    @property
    def arm(self) -> Arm: ...
    @property
    def parameter_names(self) -> list[str]:
        """The arm's, then the fitted dimensions of artefacts, such as `artefact.ball.diameter`."""
    @property
    def parameter_units(self) -> list[str]:
        """Those of the arm, or "mm", "rad" or "1" of a dimension."""
    @property
    def parameters(self) -> F64: ...
    def with_arm(self, arm: Arm) -> Problem: ...

class Fitted:
    """What a fit found and how it ended. Also what an evaluation finds: a fit with everything held."""

    @property
    def arm(self) -> Arm: ...
    @property
    def names(self) -> list[str]:
        """Of all parameters: the arm's, then the fitted dimensions of artefacts."""
    @property
    def start(self) -> F64: ...
    @property
    def parameters(self) -> F64: ...
    @property
    def termination(self) -> str:
        """ "converged-cost", "converged-step", "exact", "nothing-to-fit", "no-progress",
        "max-iterations", "poor-minimum", "held-poor", "off-scale"."""
    @property
    def converged(self) -> bool: ...
    @property
    def iterations(self) -> int: ...
    @property
    def evaluations(self) -> int: ...
    @property
    def cost_start(self) -> float:
        """Sum of squares of the whitened residuals (mm² where no noise is stated)."""
    @property
    def cost(self) -> float: ...
    @property
    def rms_start_mm(self) -> float:
        """Of a reading's residual: √(mean of squared norms), mm, unweighted."""
    @property
    def rms_mm(self) -> float: ...
    @property
    def observations(self) -> int:
        """Scalar equations: 3 per point reading, 1 per length row or touch of a surface."""
    @property
    def placement_unknowns(self) -> int: ...
    @property
    def degrees_of_freedom(self) -> float:
        """observations − placement unknowns − what readings alone determine of the parameters."""
    @property
    def variance(self) -> float:
        """Of a whitened residual, by which the covariance was made; 1 where stated noise is not contradicted."""
    @property
    def estimated(self) -> bool:
        """Whether that is from the residuals."""
    @property
    def chi2_per_dof(self) -> float | None:
        """None without stated noise or without degrees of freedom."""
    @property
    def searched_starts(self) -> int:
        """0: the given start was good enough."""
    @property
    def search_reason(self) -> str:
        """ "" or "asked", "poor-minimum", "unexplained" or "off-scale"."""
    @property
    def undecided_signs(self) -> list[list[int]]:
        """Sets of joints, from 1, that may all count the other way: readings and nominal arm do not tell."""
    @property
    def mirrored_signs(self) -> list[list[int]]:
        """Those of them with which the arm is the mirror image of the one found."""
    @property
    def folded(self) -> list[str]:
        """Which symmetries brought the found arm back near the nominal: "flip of joint 3", "mirror"."""
    @property
    def common_factor(self) -> float | None:
        """Found over drawn, where all lengths of the arm are off their start by one factor."""
    @property
    def identifiability(self) -> Identifiability: ...
    @property
    def covariance(self) -> F64:
        """(k, k) over `covariance_columns`, rad and mm, for readings of that `variance`;
        lost directions held at their values. All of it NaN where no degrees of freedom are left to
        estimate it from."""
    @property
    def covariance_columns(self) -> I64:
        """Indices of the free parameters."""
    @property
    def priors(self) -> F64:
        """(k, 2) over `covariance_columns`: value and standard uncertainty before; NaN where nothing was stated."""
    @property
    def scales(self) -> list[float]:
        """Scatter of each group, from the median, in units of the stated noise (mm where none is stated)."""
    def lengths(self, group: int) -> F64:
        """(N,): how far off each reading is, in units of its group's scatter."""
    def outliers(self, group: int) -> Bool:
        """(N,): farther off than one normal reading in ten thousand."""
    def counted(self, group: int) -> F64 | None:
        """(N,): what the loss let each reading count, 0 to 1; None without a loss."""
    def residuals(self, group: int) -> F64:
        """(N, 3) mm in the base frame: tip minus where the feature stands; for a length group (N, 1): distance minus
        length; for a surface (N, 1): distance from it, less the ball's radius."""
    def residuals_start(self, group: int) -> F64: ...
    def weights(self, group: int) -> F64:
        """(N,) root of the weight of each reading, 1/mm (1 without stated noise), isotropic equivalent."""

def fit(
    problem: Problem,
    hold: Bool,  # (parameters,) true: not fitted
    start: str = "given",  # or "search"
    max_iterations: int = 200,
    seed: int = 0,
    search_starts: int = 2000,
    known_length_mm: float = 1.0,
    known_angle_rad: float = 0.01,
    progress: Progress | None = None,
    unknown_signs: Bool | None = None,  # (n,) true: find the joint's sign
    from_parameters: F64 | None = None,  # (parameters,) where the fit begins; the arm's own stay what is nominal
    poor_above_mm: float | None = None,  # rms from which on a minimum is poor; None: the noise or the reach says
) -> Fitted:
    """Calibrate. Raises UlnaError for fewer observations than unknowns; KeyboardInterrupt when interrupted.
    Everything held: evaluate (placements are fitted, the arm is not)."""

def identify(
    problem: Problem, hold: Bool, known_length_mm: float = 1.0, known_angle_rad: float = 0.01
) -> Identifiability:
    """What these readings can and cannot determine at the problem's own arm, without fitting."""

def costs(problem: Problem, hold: Bool, parameters: F64) -> F64:
    """(k,) sums of squares at (k, free) sets of the free parameters, placements where they fit best, every reading
    weighing alike: what a search without derivatives asks for."""

def whitened_rows(problem: Problem, hold: Bool) -> tuple[F64, I64]:
    """What the readings tell of the free parameters at the problem's own arm: (R, free) rows of the Jacobian, weighed
    for the stated noise (mm where none is stated), of which no placement explains anything, and (R,) which standing
    each is of. Standings are counted as they first come in a group, group after group; rows come in their order. Of
    readings that stand nowhere, as lengths, or whose place is known, each is one. A standing of N equations and e
    unknowns leaves N - e rows: the same information whichever they are. Priors are left out."""

def rows_of_fit(problem: Problem, hold: Bool, fitted: Fitted) -> tuple[F64, F64, I64]:
    """The same rows where a fit of this problem ended, weighed as it weighed them, then the residual of each (R,), then
    its standing."""

def held_sensitivity(problem: Problem, hold: Bool, fitted: Fitted, held: I64) -> F64:
    """∂(free)/∂(held) at the solution of a fit of this problem, (free, held): how fitted parameters follow held ones
    that are themselves uncertain. `held` (h,): indices of held parameters. Units as the parameters'."""

def recalibrate(
    problem: Problem,
    hold: Bool,
    truth: Arm,
    runs: int,
    seed: int = 0,
    threads: int = 1,
    progress: Progress | None = None,
    uncertainties: bool = True,
    first: int = 0,
) -> tuple[F64, F64, Bool]:
    """Calibrations repeated on new noise: readings are taken as exact for `truth`, the problem's stated noise is drawn
    anew for each run (each fit starts at the truth). Returns parameters (runs, P), standard uncertainties
    (runs, P; NaN where held, not determined, or not asked for), converged (runs,). Run k of all draws from (seed, k);
    `first`: the k of the first run, where the work is cut."""

def choose(
    candidates: F64,  # (N, k, r) k whitened rows each, in coordinates where the mean information is about one
    count: int,
    criterion: str,  # "volume" (log det C), "mean" or "worst" (variance over directions), "widest" (of F C Fᵀ)
    directions: F64 | None = None,  # (m, r) rows F that the last three ask for
    fixed: F64 | None = None,  # (r, r) information at hand already
    seed: int = 0,
    progress: Progress | None = None,
) -> tuple[list[int], list[float], int]:
    """`count` of the candidates with a small criterion of C = M⁻¹, by exchange from a random set: their numbers, the
    criterion after each round, and how many exchanges there were. Raises UlnaError where too few are to be chosen."""

class Running:
    """What is known while readings still come: rows that are added and taken away, none started over."""

    def __init__(self, problem: Problem, hold: Bool, parameters: F64 | None = None, sigma: float | None = None) -> None:
        """Looked at from parameters (P,), None: the problem's own; sigma: of a whitened residual, as a fit of this
        problem showed it. Leaf k holds the readings of the standing that `rows_of_fit` numbers k."""
    @property
    def leaves(self) -> int:
        """How many there are, with the empty ones."""
    def put(self, leaf: int, group: int, readings: Problem) -> bool:
        """Readings of a group's artefact that stand in one place, as the only group of a problem, in place of what the
        leaf held. False: their dimensions are not the group's, so that they can only be looked at with all others."""
    def empty(self, leaf: int) -> None: ...
    def so_far(self) -> tuple[int, Bool, F64, F64]:
        """The rank; (F,) which free parameters take part in what is not determined; (F, F) covariance along what is;
        (F,) a step from `parameters` to the minimum, exact where the readings are linear."""
    def with_drawing(
        self, known_length_mm: float, known_angle_rad: float, without: int | None = None
    ) -> tuple[F64, F64]:
        """(F, F) covariance with what a drawing says of every free parameter without a prior, and (F, F) upper R of
        what is known, whitened: of these `gains` are asked. without: a leaf that is left out."""

def gains(
    candidates: F64,  # (N, k, F) whitened rows of each
    triangle: F64,  # (F, F) upper R of what is known
    directions: F64,  # (m, F) rows of what is asked for
) -> F64:
    """(N,) by how much each candidate lowers the mean variance of what is asked for. Raises UlnaError."""
