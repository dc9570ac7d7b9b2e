"""NAFEMS NL1: a point in plane strain that is strained in eight straight steps, there and back.

NAFEMS Non-Linear Benchmarks, publication NNB rev. 1, 1989, test NL1, as read in the benchmark manual of another program
(its page "NL1: Prescribed biaxial strain history, plane strain"): E 250 GPa, ν 0.25, 5 MPa, without hardening and with
62.5 GPa over the plastic strain. *Recomputed*: the rates integrated by Runge-Kutta to ten digits. The targets lie up
to 0.13 % from that while the point is strained further, and 1 % once it has come back; ours is as close to the rates as
its steps are small.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from alula.fea.plastic.yield_law import Past, YieldLaw

E, NU, YIELD = 250e3, 0.25, 5.0
ENDS = 1e-4 * np.array([[0, 0], [0.25, 0], [0.5, 0], [0.5, 0.25], [0.5, 0.5], [0.25, 0.5], [0, 0.5], [0, 0.25], [0, 0]])
TARGETS = {
    0.0: [5.0, 5.0, 5.0, 5.0, 5.0, 5.0, 3.917, 5.0],
    62.5e3: [5.0, 5.862, 5.482, 6.362, 6.640, 7.322, 4.230, 5.673],
}


def by_steps(hardening, count):
    """The von Mises stress after each of the eight, by our law in so many steps."""
    curve = ((1e-3, 1.0 + hardening * 1e-3 / YIELD),) if hardening else ()
    law, past, found = YieldLaw(E=E, nu=NU, strength=YIELD, hardening=curve), Past.none(1), []
    elastic = YieldLaw(E=E, nu=NU, strength=1.0)  # its share is the von Mises stress
    for start, stop in pairwise(ENDS):
        for part in np.linspace(0.0, 1.0, count + 1)[1:]:
            response = law.respond(np.array([[*(start + part * (stop - start)), 0, 0, 0, 0]]), past, tangent=False)
            past = response.past
        found.append(float(elastic.share(response.stress)[0]))
    return found


def by_rates(hardening):
    """The same by ordinary differential equations for the deviator and the yield stress."""
    mu, deviator, strength, found = E / 2.0 / (1.0 + NU), np.zeros(3), YIELD, []
    for start, stop in pairwise(ENDS):
        rate = 2.0 * mu * (np.array([*(stop - start), 0.0]) - (stop - start).sum() / 3.0)
        a, b, c = 1.5 * rate @ rate, 3.0 * deviator @ rate, 1.5 * deviator @ deviator - strength**2
        begin = min((-b + np.sqrt(max(b * b - 4.0 * a * c, 0.0))) / (2.0 * a), 1.0)  # it leaves the elastic domain

        def flow(_, y, rate=rate):
            normal = 1.5 * y[:3] / np.sqrt(1.5 * y[:3] @ y[:3])
            plastic = normal @ rate / (3.0 * mu + hardening)
            return [*(rate - 2.0 * mu * plastic * normal), hardening * plastic]

        y = np.array([*(deviator + begin * rate), strength])
        if begin < 1.0:
            y = solve_ivp(flow, (begin, 1.0), y, rtol=1e-10, atol=1e-10).y[:, -1]
        deviator, strength = y[:3], y[3]
        found.append(float(np.sqrt(1.5 * deviator @ deviator)))
    return found


@pytest.mark.parametrize("hardening", TARGETS)
def test_nl1(hardening):
    rates, fine, coarse = by_rates(hardening), by_steps(hardening, 200), by_steps(hardening, 50)
    assert rates == pytest.approx(TARGETS[hardening], rel=0.01)
    assert rates[:6] == pytest.approx(TARGETS[hardening][:6], rel=0.0013)
    assert fine == pytest.approx(rates, rel=0.002)
    errors = [np.abs(np.subtract(one, rates)).max() for one in (coarse, fine)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)  # implicit Euler is of order 1
