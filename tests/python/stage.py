"""A small stage with prescribed stiffness, whose runs take tenths of a second."""

from pathlib import Path

TEXT = """\
title = "Small"
[stage]
kind = "planetary"
planets = 5
module_mm = 3.8
pressure_angle_deg = 22.5
face_width_mm = 88
centre_distance_mm = 201
power_kW = 2958.8
sun_speed_rpm = 1128
[material]
youngs_modulus_GPa = 206
[sun]
teeth = 48
bore_diameter_mm = 130
profile_shift = 0.7608
mass_kg = 66
inertia_kg_m2 = 0.54895
[planet]
teeth = 55
profile_shift = 0.7361
bore_diameter_mm = 172
mass_kg = 8.51
inertia_kg_m2 = 0.09282
[carrier]
mass_kg = 400.1
inertia_kg_m2 = 15.3193
[[ring]]
name = "held"
structure = "traditional"
teeth = 162
profile_shift = 0.1516
outside_diameter_mm = 663.6
mass_kg = 31.25
inertia_kg_m2 = 2.9606
[supports]
sun_N_per_m = 1e7
planet_N_per_m = 1e9
carrier_N_per_m = "rigid"
ring_N_per_m = "rigid"
[mesh.sun_planet]
stiffness = "harmonic"
mean_N_per_m = 1.364e9
ripple = 0.2258
[mesh.ring_planet]
stiffness = "harmonic"
mean_N_per_m = 1.87e9
ripple = 0.1294
[dynamics]
half_backlash_um = 0
mesh_damping_ratio = 0.05
support_damping_ratio = 0.05
"""


def write(folder):
    """The file of the stage in a folder."""
    file = Path(folder) / "small.toml"
    file.write_text("# A comment.\n" + TEXT)
    return file
