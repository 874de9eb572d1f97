#!/usr/bin/env python3
"""Rows of tables in documents, made again from the run that prints them.

    printed_results.py PROGRAM SOURCE_FOLDER SCENE OUT     runs the scene into OUT, where unchanged results are reused
    printed_results.py --list                              the scenes

Every row that a page prints of a scene is listed here with its sources in summary.json. A row that the page does not
have as the run gives it is an error. Sentences around the tables are not compared.
"""
import json
import math
import pathlib
import subprocess
import sys


def measured(value, error):
    """As the program prints a value with its error: two digits of the error, five of the value at most."""
    if not error or not math.isfinite(error):
        return f"{value:.5g}"
    digit = lambda x: math.floor(math.log10(abs(x)))
    decimals = max(0, min(1 - digit(error), 4 - digit(value), 9))
    unseen = error < 0.5 * 10.0**-decimals
    return f"{value:.{decimals}f} ± {'<' if unseen else ''}{10.0 ** -decimals if unseen else error:.{decimals}f}"


class Summary:
    def __init__(self, folder):
        with open(folder / "summary.json", encoding="utf-8") as file:
            self.data = json.load(file)
        self.figures = {v["name"]: v["figures"] for v in self.data["variants"]}

    def at(self, path):
        data = self.data
        for key in path.split("/"):
            data = data[int(key)] if isinstance(data, list) else data[key]
        return data

    def value(self, path, scale=1):
        found = self.at(path)
        return scale * (found["value"] if isinstance(found, dict) else found)

    def bar(self, path, scale=1):
        found = self.at(path)
        error = found["error"] if "error" in found else (found["error_relative"] or 0) * found["value"]
        return measured(scale * found["value"], scale * error)

    def result(self, variant, key, scale=1):
        found = self.figures[variant][key]
        return measured(scale * found["value"], scale * found["error"])

    def number(self, variant, key, scale=1):
        return scale * self.figures[variant][key]["value"]


RINGS = ["traditional", "pinned", "thin-walled"]


def ring_types(s):
    row = lambda name, cell: f"| {name} | " + " | ".join(cell(r) for r in RINGS) + " |"
    sharing = lambda kind: lambda r: s.result(r, f"sun_planet_load_sharing_{kind}")
    return "docs/ring_types.md", [
        row("mean stiffness of the ring mesh, N/µm", lambda r: s.result(r, "ring_planet_mean_stiffness_N_per_m", 1e-6)),
        row("transmission error, mean, µm", lambda r: s.result(r, "ring_planet_lte_mean_m", 1e6)),
        row("transmission error, peak to peak, µm", lambda r: s.result(r, "ring_planet_lte_peak_to_peak_m", 1e6)),
        row("load sharing, averaged over a mesh cycle", sharing("averaged")),
        row("load sharing, instantaneous", sharing("instantaneous")),
        row("load sharing, quasi-static", sharing("quasi_static")),
        row("peak factor, sun meshes", lambda r: s.result(r, "sun_planet_peak_factor")),
        row("peak factor, ring meshes", lambda r: s.result(r, "ring_planet_peak_factor")),
    ]


def ring_types_uncertainty(s):
    row = lambda name, cell: f"| {name} | " + " | ".join(cell(r) for r in RINGS) + " |"
    sampled = lambda r, key: s.at(f"rings/{r}/monte_carlo/sun_planet_{key}")

    def mean(key):
        def cell(r):
            m = sampled(r, key)["mean"]
            return f"{m['value']:.3f} [{m['low']:.3f}, {m['high']:.3f}]"

        return cell

    sharing = "load_sharing_averaged"
    quantile = lambda r, q: sampled(r, sharing)[q]["value"]
    rows = [
        row("load sharing, averaged: mean", mean(sharing)),
        row("its standard deviation over the phases", lambda r: f"{sampled(r, sharing)['standard_deviation']:.3f}"),
        row("5 % and 95 % quantiles", lambda r: f"{quantile(r, 'quantile_05'):.3f}, {quantile(r, 'quantile_95'):.3f}"),
        row("peak factor: mean", mean("peak_factor")),
    ]
    for name, key in [("P50", "p50"), ("P95", "p95"), ("P99", "p99")]:
        rows.append(row(f"K_γ {name} of the assemblies", lambda r: s.result(r, f"load_sharing_of_assemblies_{key}")))
    varied = {i["input"]: i for i in s.at("sensitivity/inputs")}

    def both(path):
        cells = []
        for key in ["load_sharing_averaged", "peak_factor"]:
            for ring in ["traditional", "thin-walled"]:
                sides = varied[path]["rings"][ring]
                low, high = (sides[side][f"sun_planet_{key}"] for side in ["divided", "multiplied"])
                cells.append(f"{low:.3f} … {high:.3f}")
        return " | ".join(cells)

    for name, path in [
        ("planet bearing 1e9 N/m", "supports.planet_N_per_m"),
        ("sun support 1e7 N/m", "supports.sun_N_per_m"),
        ("mesh damping 0.07", "dynamics.mesh_damping_ratio"),
    ]:
        rows.append(f"| {name} | {both(path)} |")
    return "docs/ring_types.md", rows


def ring_types_variants(s):
    names = {
        "traditional": "traditional",
        "sleeve8p8x18": "sleeve 8.8 mm × 18 mm",
        "sleeve18x10p6": "sleeve 18 mm × 10.6 mm",
        "sleeve40x4p7": "sleeve 40 mm × 4.7 mm",
    }
    rows = []
    for ring in s.figures:
        title = names.get(ring, f"{''.join(c for c in ring if c.isdigit())} pins")
        stiffness = s.number(ring, "ring_planet_mean_stiffness_N_per_m", 1e-6)
        lte = s.number(ring, "ring_planet_lte_peak_to_peak_m", 1e6)
        rows.append(
            f"| {title} | {stiffness:.0f} | {lte:#.3g} | {s.number(ring, 'sun_planet_load_sharing_averaged'):.3f} "
            f"| {s.number(ring, 'sun_planet_peak_factor'):.3f} |".replace(". |", " |")
        )
    return "docs/ring_types.md", rows


def arc_tooth_2kv(s):
    arc_seconds, per_arc_minute = 180 * 3600 / math.pi, math.pi / 180 / 60
    stiffness = lambda at: s.value(f"{at}vibration/torsional_stiffness/mean_Nm_per_rad", per_arc_minute)
    first = [f["figures"]["frequency_1_Hz"] for f in s.data["variants"]]
    second = [f["figures"]["frequency_2_Hz"] for f in s.data["variants"]]
    bar = lambda f: measured(f["value"], f["error"])
    rows = [
        f"| sun mesh, mean, N/µm | {s.value('sun_planet/mean_stiffness_N_per_m', 1e-6):.0f} "
        f"| {s.bar('computed/sun_planet/mean_stiffness_N_per_m', 1e-6)} |",
        f"| arc mesh, mean, N/µm | {s.value('arc_pins/mean_stiffness_N_per_m', 1e-6):.0f} "
        f"| {s.value('computed/arc_pins/mean_stiffness_N_per_m', 1e-6):.0f} |",
        f"| first frequency, Hz | {first[0]['value']:.2f} | {bar(first[1])} |",
        f"| second frequency, Hz | {second[0]['value']:.0f} | {bar(second[1])} |",
        f"| torsional stiffness from the output, N m/arc minute | {stiffness(''):.1f} | {stiffness('computed/'):.1f} |",
        f"| output error under load, peak to peak, arc seconds | 0 "
        f"| {s.bar('computed/motion/output_error_peak_to_peak_rad', arc_seconds)} |",
    ]
    titles = {
        "stage.module_mm": "module",
        "input.inertia_kg_m2": "input inertia",
        "crank.bearing_N_per_m": "crank bearing",
        "stage.eccentricity_mm": "eccentricity",
        "arc_gear.bearing_N_per_m": "arc gear bearing",
        "planet.inertia_kg_m2": "planet inertia",
        "mesh.arc_pins.mean_N_per_m": "arc mesh",
    }
    for i in s.at("vibration/first_frequency_inputs"):
        if i["input"] in titles:
            power = f"{i['d_ln_f_per_d_ln_p']:+.3f}".replace("-", "−")
            rows.append(f"| {titles[i['input']]} | {power} |")
    return "docs/arc_tooth_2kv.md", rows


def helical_pair(s):
    um = lambda x: f"{1e6 * x:.3f}"
    rows = []
    for title, key in [
        ("T of one gear, one-sided", "pinion_error"),
        ("magnitude of T", "pinion_error_magnitude"),
        ("X₁", "pinion_x1"),
        ("envelope √(X₁² + X₂²), **used**", "pinion_envelope"),
        ("sum of both gears, one-sided", "sum"),
    ]:
        r = s.at(f"manufacturing_error/readings/{key}")
        low_high = f"{um(r['low_m'])} … {um(r['high_m'])}"
        rows.append(f"| {title} | {um(r['sample_m'])} | {low_high} | {um(r['exact_m'])} |")
    iso = s.value("mean_stiffness_N_per_m/iso_6336", 1e-6)
    rows.append(f"| ISO 6336-1, method B, with ε_α = {s.at('derived/transverse_contact_ratio'):.3f} | {iso:.0f} |")
    closed = s.value("mean_stiffness_N_per_m/closed_form", 1e-6)
    rows.append(f"| closed form of the transverse section, staggered along the helix | {closed:.0f} |")
    return "docs/helical_pair.md", rows


def helical_pair_solid(s):
    return "docs/helical_pair.md", [
        f"| finite elements, solid | {s.bar('mean_stiffness_N_per_m/computed', 1e-6)} |"
    ]


def backlash_optimisation(s):
    best = s.at("optimise/given/figures")
    sun, ring = (best[f"{m}_planet_load_sharing_instantaneous"] for m in ["sun", "ring"])
    return "docs/backlash_optimisation.md", [
        f"| any backlash, no lag of the ring mesh | {sun:.4f} | {ring:.4f} | {(sun + ring) / 2:.4f} |"
    ]


def tip_relief_optimisation(s):
    given, best = (s.at(f"optimise/{which}/figures") for which in ["given", "best"])
    row = lambda title, key: f"| {title} | {given[key]:.3f} | {best[key]:.3f} |"
    return "docs/backlash_optimisation.md", [
        row("load sharing, averaged over a mesh cycle", "sun_planet_load_sharing_averaged"),
        row("load sharing, instantaneous", "sun_planet_load_sharing_instantaneous"),
        row("largest peak factor", "sun_planet_peak_factor"),
    ]


SCENES = {
    f.__name__: f
    for f in [
        ring_types,
        ring_types_uncertainty,
        ring_types_variants,
        arc_tooth_2kv,
        helical_pair,
        helical_pair_solid,
        backlash_optimisation,
        tip_relief_optimisation,
    ]
}


def main(arguments):
    if arguments == ["--list"]:
        print("\n".join(SCENES))
        return 0
    program, source, scene, out = arguments[0], pathlib.Path(arguments[1]), arguments[2], pathlib.Path(arguments[3])
    command = [program, "run", str(source / f"data/scenes/{scene}.toml"), "-o", str(out), "--quiet"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    page, rows = SCENES[scene](Summary(out))
    lines = (source / page).read_text(encoding="utf-8").splitlines()
    missing = [row for row in rows if not any(line.startswith(row.rstrip("| ")) for line in lines)]
    for row in missing:
        print(f"{page} does not have the row that data/scenes/{scene}.toml gives:\n  {row}")
    print(f"{len(rows) - len(missing)} of {len(rows)} rows of {page} are those of {scene}")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
