"""Bands of the stress in eyes under the law of contact, against contact solutions of eyes drawn at random.

Eyes of ``THINNEST`` to 4.2 bores with shanks of 0.55 to 1 diameters, pulled at up to ``ASKEW``; rigid pins, steel in
aluminium or plastic, and pins of the eye's material; E c t/F of 0.03 to 200. A band goes from the least stress under
both laws to the largest over 1 - ``CONTACT_SHORTFALL``.

    python -m benchmarks.contact_eyes SEED COUNT
"""

import math
import sys

import numpy as np

from alula.fea.tractions.seated import ASKEW, NARROWER, NARROWEST, THINNEST, WIDER
from alula.loads.records.bearing import CONTACT_SHORTFALL
from alula.loads.records.contact import eye_half_angle, pressure
from benchmarks import contact_plane as plane


def main(seed: int, count: int) -> None:
    """Print how many bands hold, by how much the others miss, and how wide they are beside those of two spans."""
    rng = np.random.default_rng(seed)
    held, by_spans, low, high, widths, spans = 0, 0, [], [], [], []
    for _ in range(count):
        ratio, askew, shank = rng.uniform(THINNEST, 4.2), rng.uniform(0.0, ASKEW), rng.uniform(0.55, 1.0)
        pin = rng.choice([0.0, 0.03, 0.33, 1.0])
        eye = plane.eye(ratio, askew, shank=shank, finest=0.6)
        shaft = plane.pin(eye.corners, young=1.0 / pin) if pin else None

        def stress(p, alpha, eye=eye, ratio=ratio):
            found, x = eye.stress(p * plane.FORCE / (eye.resultants[:, 0] @ p))
            near = np.hypot(*x) < 1.03 * ratio
            if alpha < NARROWEST + NARROWER:  # what is local under the pin is told apart
                near &= (np.abs(np.arctan2(x[1], x[0])) > max(alpha + WIDER, NARROWEST) + 0.1) | (np.hypot(*x) > 1.8)
            return np.array([plane.von_mises(found)[near].max(), plane.principal(found)[near].max()])

        for clearance in 10.0 ** rng.uniform(-1.5, 2.3, size=7):
            truth = plane.contact(eye, clearance, shaft)
            alpha = float(eye_half_angle(clearance, stiffer=2.0 / (1.0 + pin), ratio=ratio))
            ends = [max(alpha + off, NARROWEST) for off in (WIDER, -NARROWER)]
            laws = [stress(pressure(eye.corners, end), alpha) for end in ends]
            cosines = [
                np.where(abs(wave * eye.corners) < math.pi / 2, np.cos(wave * eye.corners), 0.0) for wave in (1, 2)
            ]
            before = [stress(p, alpha) for p in cosines]
            found = stress(truth, alpha)
            least, most = np.min(laws, axis=0), np.max(laws, axis=0) / (1.0 - CONTACT_SHORTFALL)
            low, high = [*low, *(found / least)], [*high, *(found / most)]
            held += int(((least <= found) & (found <= most)).sum())
            widths += [*(most / least)]
            bottom, top = np.min(before, axis=0), np.max(before, axis=0) / (1.0 - CONTACT_SHORTFALL)
            by_spans += int(((bottom <= found) & (found <= top)).sum())
            spans += [*(top / bottom)]
    print(
        f"{held} of {len(low)} bands hold; stress over their low ends {min(low):.3f} at least, over the high ones ",
        end="",
    )
    print(f"{max(high):.3f} at most; width {np.median(widths):.2f} (two spans: {by_spans}, {np.median(spans):.2f})")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
