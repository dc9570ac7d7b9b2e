"""A crank rocker whose rocker alone has a part, which turns through seven poses: quick to mesh and to solve."""

TOML = """
schema_version = 1
title = "A rocker with a part"
links.base = { ground = true, points = { O2 = ["0 mm", "0 mm"], O4 = ["60 mm", "0 mm"] } }
links.crank = { points = { O2 = ["0 mm", "0 mm"], A = ["20 mm", "0 mm"] } }
links.coupler = { points = { A = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"] } }
links.rocker.part = "bar"
links.rocker.points = { O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"], P = ["60 mm", "0 mm"] }
links.rocker.end_patch = "4 mm"
joints.O2 = { links = ["base", "crank"], pin_diameter = "3 mm" }
joints.A = { links = ["crank", "coupler"], pin_diameter = "3 mm" }
joints.B = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }
joints.O4 = { links = ["base", "rocker"], pin_diameter = "3 mm" }
pose = { coordinate = "crank", angle = "40 deg", near = { coupler = "20 deg", rocker = "60 deg" } }
drive = { link = "crank", joint = "O2" }
motion = { range = ["40 deg", "80 deg"], poses = 7 }
load_cases.turn = { moments = [{ link = "rocker", at = "P", moment = "20 N*mm" }] }
solid = { mesh_size = 3.0 }
[parts.bar]
shape = "bar"
material = "pvc-paredes-2018"
width = "8 mm"
thickness = "4 mm"
eye_diameter = "12 mm"
eye_thickness = "4 mm"
fillet_radius = "2 mm"
"""
