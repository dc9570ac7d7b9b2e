"""The owl wing held at AE in large displacement, a second way: elastic chains, energy, and the tip's fall prescribed.

Links AE, CF and CH are chains of rigid segments with rotational springs between them (Hencky's bar chain, which
converges to the inextensible elastica with the square of the segment's length); GF and ED, pinned at both ends and
unloaded between, are rigid bars. The unknowns are directions alone, closure is a constraint, and so is the height of
the tip: its multiplier is the load that holds the wing there. The load so is an outcome, and the path can be followed
through its maximum, where load stepping ends. Nothing here is shared with the co-rotational frame.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from alula.fea.frame.build import build_frame
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.equilibrium_path import NoEquilibriumError
from alula.loads.case.case_file import read_case
from alula.loads.records.applied import PointLoad
from alula.loads.statics.statics import Drive

EI = 2400.0 * np.pi / 64.0 * (5.0**4 - 2.5**4)
WEIGHT = 0.25
DROPS = np.arange(0.25, 24.0, 0.25)


@dataclass
class Path:
    """Tip's fall [mm], load [N] and direction of GF [degrees] of every equilibrium."""

    fall: np.ndarray
    load: np.ndarray
    direction: np.ndarray


def meeting(p, r, q, s, side):
    d = abs(q - p)
    a = (r**2 - s**2 + d**2) / (2 * d)
    return p + (a + side * 1j * np.sqrt(r**2 - a**2)) * (q - p) / d


def elastic_chain(segments: int, eyes: float = 1.0, drops: np.ndarray = DROPS) -> Path:
    """Follow the wing down; ``segments`` per stretch between two pins.

    Springs next to a pin give ``eyes`` times as much.
    """
    A, G = 0j, 125j
    F = G + 50 * np.exp(1j * np.radians(228.15))
    B = meeting(A, 112, F, 60, 1)
    E, C = B * 190 / 112, F + (B - F) * 150 / 60
    D = meeting(E, 88, C, 77, -1)
    H = C + (D - C) * 124 / 77
    angle, length, springs, stretch = [], [], [], {}
    for name, start, end, parts in (("AE", A, E, (112, 78)), ("CF", F, C, (60, 90)), ("CH", C, H, (77, 47))):
        first = len(angle)
        for k, part in enumerate(parts):
            stretch[name, k] = slice(len(angle), len(angle) + segments)
            angle += [np.angle(end - start)] * segments
            length += [part / segments] * segments
        springs += [(i, i + 1, EI / ((length[i] + length[i + 1]) / 2)) for i in range(first, len(angle) - 1)]
    gf, ed = len(angle), len(angle) + 1
    start = np.array([*angle, np.angle(F - G), np.angle(D - E)])
    length = np.array([*length, 50.0, 88.0])
    K = np.zeros((len(start), len(start)))
    pins = {end for part in stretch.values() for end in (part.start, part.stop)}
    springs = [(i, j, k / (eyes if pins & {i, j, j + 1} else 1.0)) for i, j, k in springs]
    for i, j, k in springs:
        K[np.ix_([i, j], [i, j])] += k * np.array([[1, -1], [-1, 1]])
    K[0, 0] += EI / (length[0] / 2) / eyes  # the drive holds AE at A
    W = np.zeros((3, len(start)))
    W[0, stretch["AE", 0]] = 1
    W[0, [gf, *range(*stretch["CF", 0].indices(999))]] = -1
    for name, k, sign in (("AE", 0, 1), ("AE", 1, 1), ("CF", 0, -1), ("CF", 1, -1), ("CH", 0, -1)):
        W[1, stretch[name, k]] = sign
    W[1, [ed, gf]] = 1, -1
    for key in (("CF", 0), ("CF", 1), ("CH", 0), ("CH", 1)):
        W[2, stretch[key]] = 1
    W[2, gf] = 1
    W = W * length
    assert np.abs(W @ np.exp(1j * start) - [G, G, H - G]).max() < 1e-9

    def real(z):
        return np.vstack([z[0].real, z[0].imag, z[1].real, z[1].imag, z[2].imag])

    t, m, found = start.copy(), np.zeros(5), []
    for fall in drops:
        for _ in range(30):
            e = np.exp(1j * t)
            gap = real((W @ e - [G, G, H - G + -1j * fall])[:, None])[:, 0]
            J, curvature = real(W * 1j * e), real(-W * e)
            matrix = np.block([[K + np.diag(m @ curvature), J.T], [J, np.zeros((5, 5))]])
            step = np.linalg.solve(matrix, -np.concatenate([K @ (t - start) + J.T @ m, gap]))
            t, m = t + step[:-5], m + step[-5:]
            if np.abs(step[:-5]).max() < 1e-11:
                break
        else:
            raise AssertionError(f"no equilibrium with the tip {fall} mm lower")
        found.append((m[4], np.degrees(t[gf]) % 360))
    load, direction = np.array(found).T
    return Path(fall=drops, load=load, direction=direction)


def frame_under(share: float):
    case = read_case("owl-wing-static")
    load = PointLoad(link="CH", point="H", wrench=np.array([0, -share * WEIGHT, 0, 0, 0, 0]))
    return build_frame(case, case.solve_pose(), (load,), held=Drive(link="AE", joint="A"))


def test_the_load_has_a_maximum_far_below_the_wings_weight() -> None:
    """Segments halved: the maximum converges with their square, to 0.204 of the weight."""
    peaks = [float(elastic_chain(n).load.max()) / WEIGHT for n in (6, 12, 24)]
    assert (peaks[1] - peaks[0]) / (peaks[2] - peaks[1]) == pytest.approx(4.0, abs=0.3)
    limit = peaks[2] + (peaks[2] - peaks[1]) / 3.0
    assert limit == pytest.approx(0.204, abs=5e-4)
    with pytest.raises(NoEquilibriumError) as ended:
        solve_large_displacement(frame_under(1.0).model, 2, least_step=1 / 512, most_iterations=15)
    assert limit - 1 / 256 <= ended.value.reached <= limit


def test_beyond_the_maximum_the_wing_needs_less_and_less_load_to_fall() -> None:
    path = elastic_chain(12)
    top = int(path.load.argmax())
    assert 0 < top < len(path.load) - 1
    assert np.all(np.diff(path.load)[top:] < 0.0)
    # GF runs towards the direction (213.51°) at which AE turns back and holds nothing.
    assert np.all(np.diff(path.direction) < 0.0)
    assert path.direction[top] == pytest.approx(220.9, abs=0.2)


@pytest.mark.parametrize("share", [0.05, 0.1, 0.18])
def test_below_it_both_ways_fall_alike(share: float) -> None:
    path = elastic_chain(24)
    rising = slice(0, int(path.load.argmax()) + 1)
    frame = frame_under(share)
    found = solve_large_displacement(frame.model, 4)
    fall = -frame.at_points(found.displacements)["CH", "H"][1]
    assert fall == pytest.approx(np.interp(share * WEIGHT, path.load[rising], path.fall[rising]), rel=0.01)


@pytest.mark.parametrize("eyes", [0.5, 1.5, 2.0])
def test_eyes_that_give_more_lower_the_limit_load_by_what_they_add_to_the_work_of_the_load(eyes: float) -> None:
    """What the band of the limit load takes for eyes, here beside every pin; exact were the wing softer alike."""

    def found(eyes: float) -> tuple[float, float]:
        small = np.array([1e-3])
        return float(elastic_chain(12, eyes).load.max()), float(small[0] / elastic_chain(12, eyes, small).load[0])

    (plain, give), (limit, soft) = found(1.0), found(eyes)
    assert abs(soft / give - 1.0) > 0.1
    assert limit * soft == pytest.approx(plain * give, rel=0.02)
