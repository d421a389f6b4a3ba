#!/usr/bin/env python3
"""Runs masses with rebound (pip install rebound), the judge of trials of systems in tests/core/trial.rs.

Usage: rebound_trial.py [STEP_SECS]: with a step by leapfrog, else by IAS15, which does not end at a meeting of points.

Standard input: the seconds to run, then for each mass a line of its gravitational parameter (m3/s2), position (m),
velocity (m/s) and radius (m). Standard output: `end SECONDS`, or `collision SECONDS` at the end of the
step in which two spheres met; then a line of position and velocity for each mass.
"""
import sys

import rebound


def main():
    lines = sys.stdin.read().split("\n")
    secs = float(lines[0])
    sim = rebound.Simulation()
    sim.G = 1.0
    for line in filter(None, lines[1:]):
        m, x, y, z, vx, vy, vz, r = map(float, line.split())
        sim.add(m=m, x=x, y=y, z=z, vx=vx, vy=vy, vz=vz, r=r)
    sim.integrator = "leapfrog" if len(sys.argv) > 1 else "ias15"
    if len(sys.argv) > 1:
        sim.dt = float(sys.argv[1])
    sim.collision = "line"
    sim.collision_resolve = "halt"
    try:
        sim.integrate(secs)
        print("end", repr(sim.t))
    except rebound.Collision:
        print("collision", repr(sim.t))
    for p in sim.particles:
        print(*map(repr, (p.x, p.y, p.z, p.vx, p.vy, p.vz)))


main()
