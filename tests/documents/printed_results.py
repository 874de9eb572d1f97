#!/usr/bin/env python3
"""Numbers of documents, made again from the runs that print them.

    printed_results.py PROGRAM SOURCE_FOLDER SCENE OUT     runs the scene into OUT, where unchanged results are reused
    printed_results.py --list                              the scenes

Each scene has a function of its name. For every page it returns the rows of tables and the parts of sentences that have
numbers of the run. A text that is not in its page is an error. Line breaks of a page count as blanks.
"""
import csv
import html
import json
import math
import pathlib
import re
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


def at_most(value, decimals):
    """Rounded up."""
    return f"{math.ceil(value * 10**decimals) / 10**decimals:.{decimals}f}"


def only_if(true, text):
    """A sentence that holds for this run, or one that no page has."""
    return text if true else f"(does not hold for this run) {text}"


def folded(text):
    return " ".join(text.split())


class Run:
    """A scene run into a folder: results of summary.json, columns of tables, text of the report."""

    def __init__(self, program, scene, out, *changes):
        self.program, self.scene, self.out = program, scene, out
        command = [program, "run", str(scene), "-o", str(out), "--quiet"]
        for change in changes:
            command += ["--set", change]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.data = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        self.figures = {v["name"]: v["figures"] for v in self.data["variants"]}

    def changed(self, *changes, scene=None):
        """The same scene, or one that this run wrote, with other values; in a folder beside this one."""
        scene = self.out / scene if scene else self.scene
        folder = re.sub(r"\W+", "_", "_".join([self.out.name, scene.stem, *changes]))
        return Run(self.program, scene, self.out.with_name(folder), *changes)

    def command(self, name, *options):
        """Standard output of another command of the scene."""
        return subprocess.run([self.program, name, str(self.scene), *options], check=True, capture_output=True).stdout

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

    def spread(self, variant, key):
        """As the program prints samples: two digits of their range."""
        found = self.figures[variant][key]["spread"]
        low, median, high = (found[q] for q in ["quantile_05", "median", "quantile_95"])
        decimals = max(0, 1 - math.floor(math.log10(high - low)))
        return f"{median:.{decimals}f} ({low:.{decimals}f} to {high:.{decimals}f})"

    def columns(self, table):
        """Values of every column."""
        with open(self.out / table, encoding="utf-8") as lines:
            rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        return {name: [float(row[name] or "nan") for row in rows] for name in rows[0]}

    def reported(self, pattern):
        """The groups of a pattern in the text of the report."""
        page = (self.out / "report.html").read_text(encoding="utf-8")
        text = folded(html.unescape(re.sub(r"(?s)<(svg|script|style).*?</\1>|<[^>]+>", " ", page)))
        found = re.search(pattern, text)
        if not found:
            raise SystemExit(f"the report of {self.scene.name} has no '{pattern}'")
        return found.groups()


RINGS = ["traditional", "pinned", "thin-walled"]


def ring_row(name, cell):
    return f"| {name} | " + " | ".join(cell(ring) for ring in RINGS) + " |"


def coupling(s, ring):
    """Largest deflection under the load of another mesh, in per cent of that under its own load."""
    table = s.columns(f"{ring}/ring_coupling.csv")
    largest = max(abs(v) for name, values in table.items() if name.startswith("compliance") for v in values)
    return 100 * largest * s.number(ring, "ring_planet_mean_stiffness_N_per_m")


def ring_types(s):
    row = lambda title, key, scale=1: ring_row(title, lambda r: s.result(r, key, scale))
    rows = [
        row("mean stiffness of the ring mesh, N/µm", "ring_planet_mean_stiffness_N_per_m", 1e-6),
        row("transmission error, mean, µm", "ring_planet_lte_mean_m", 1e6),
        row("transmission error, peak to peak, µm", "ring_planet_lte_peak_to_peak_m", 1e6),
        row("load sharing, averaged over a mesh cycle", "sun_planet_load_sharing_averaged"),
        row("load sharing, instantaneous", "sun_planet_load_sharing_instantaneous"),
        row("load sharing, quasi-static", "sun_planet_load_sharing_quasi_static"),
        row("peak factor, sun meshes", "sun_planet_peak_factor"),
        row("peak factor, ring meshes", "ring_planet_peak_factor"),
    ]
    stiffness = s.at("rings/traditional/ring_planet/mean_stiffness_N_per_m")
    part = lambda *names: sum(100 * stiffness["error_parts_relative"][name] for name in names)
    share = {r: f"{coupling(s, r):.1f} %" for r in RINGS}
    # Of every ring: without coupling, with the static one, with elastic modes.
    effect = {r: s.columns(f"{r}/dynamics/rim_coupling.csv") for r in ["pinned", "thin-walled"]}
    static = max(abs(e[key][1] - e[key][0]) for e in effect.values() for key in e if "load_sharing" in key)
    elastic = lambda key: f"{abs(effect['thin-walled'][key][2] - effect['thin-walled'][key][1]):.4f}"
    modes = s.columns("thin-walled/ring_modes.csv")
    path = [s.reported(rf"{r} [\d.]+ ([\d.]+) % [\d.]+ % ([\d.]+) %") for r in RINGS]
    mesh, bearing = ([float(shares[i]) for shares in path] for i in [0, 1])
    pressure_angle = float(s.reported(r"ring_mesh_working_pressure_angle_deg traditional ([\d.]+)")[0])
    averaged = [s.number(r, "sun_planet_load_sharing_averaged") for r in RINGS]
    sentences = [
        f"The traditional ring's stiffness has an error of {100 * stiffness['error_relative']:.1f} %.",
        f"Of this, {part('model_choice'):.1f} % are plane strain",
        f"The elements and the pressure on the flanks cause {part('discretisation', 'local_contact'):.1f} %.",
        f"fluctuates by {s.number('pinned', 'ring_planet_stiffness_ripple', 100):.0f} % of its mean stiffness",
        f"at most {share['thin-walled']} on the thin-walled ring, {share['pinned']} on the pinned one and "
        f"{share['traditional']} on the traditional one",
        f"changes no load sharing coefficient by more than {at_most(static, 4)}",
        f"(from {modes['frequency_Hz'][0]:.0f} Hz, {modes['waves'][0]:.0f} waves)",
        f"instantaneous coefficient by {elastic('sun_planet_load_sharing_instantaneous')} and its peak factors by "
        f"{elastic('sun_planet_peak_factor')} (sun meshes) and {elastic('ring_planet_peak_factor')} (ring meshes)",
        f"the bearing contributes {min(bearing):.0f} to {max(bearing):.0f} %, the ring mesh {min(mesh):.0f} to "
        f"{max(mesh):.0f} %",
        f"leaves the pitch point at {pressure_angle:.1f}°",
        f"difference between the rings is {max(averaged) - min(averaged):.3f} instead of 0.07",
    ]
    titles = {"traditional": "outside fixed", "pinned": "24 pins", "thin-walled": "cantilever"}
    orders = [o for o in s.at("monte_carlo/orders") if o["result"] == "sun_planet_load_sharing_averaged"]
    same_order = all(o["share"]["value"] in (0, 1) for o in orders)
    readme = [
        f"| {r} ({titles[r]}) | {s.result(r, 'ring_planet_mean_stiffness_N_per_m', 1e-6)} "
        f"| {s.result(r, 'ring_planet_lte_peak_to_peak_m', 1e6)} | {s.spread(r, 'sun_planet_load_sharing_averaged')} "
        f"| {s.spread(r, 'sun_planet_dynamic_factor')} | {s.spread(r, 'sun_planet_peak_factor')} |"
        for r in RINGS
    ]
    readme += [
        f"the median of {s.figures['pinned']['sun_planet_peak_factor']['spread']['samples']} samples",
        only_if(same_order, "The order of the rings in load sharing is the same in every sample."),
    ]
    return {"docs/ring_types.md": rows + sentences, "README.md": readme}


def ring_types_uncertainty(s):
    sampled = lambda r, key: s.at(f"rings/{r}/monte_carlo/sun_planet_{key}")

    def mean(key):
        def cell(r):
            m = sampled(r, key)["mean"]
            return f"{m['value']:.3f} [{m['low']:.3f}, {m['high']:.3f}]"

        return cell

    sharing = "load_sharing_averaged"
    deviation = lambda r: f"{sampled(r, sharing)['standard_deviation']:.3f}"
    quantiles = {r: [sampled(r, sharing)[q]["value"] for q in ["quantile_05", "quantile_95"]] for r in RINGS}
    half_range = max(high - low for low, high in quantiles.values()) / 2
    means = [sampled(r, sharing)["mean"]["value"] for r in RINGS]
    texts = [
        ring_row("load sharing, averaged: mean", mean(sharing)),
        ring_row("its standard deviation over the phases", deviation),
        ring_row("5 % and 95 % quantiles", lambda r: ", ".join(f"{q:.3f}" for q in quantiles[r])),
        ring_row("peak factor: mean", mean("peak_factor")),
        f"change the coefficient by ±{half_range:.1f}, the ring by {max(means) - min(means):.2f}",
    ]
    for name in ["P50", "P95", "P99"]:
        key = f"load_sharing_of_assemblies_{name.lower()}"
        texts.append(ring_row(f"K_γ {name} of the assemblies", lambda r: s.result(r, key)))

    order = {(o["result"], o["ring"], o["above"]): o for o in s.at("monte_carlo/orders")}
    above = lambda key, ring, other: order[f"sun_planet_{key}", ring, other]
    same = [o for o in order.values() if o["result"] == f"sun_planet_{sharing}"]
    certain = min(max(o["share"]["low"], 1 - o["share"]["high"]) for o in same)
    texts.append(only_if(all(o["share"]["value"] in (0, 1) for o in same), f"(share above {100 * certain:.1f} %)"))
    peak = above("peak_factor", "traditional", "pinned")
    percent = {key: f"{100 * value:.0f}" for key, value in peak["share"].items()}
    texts += [
        f"in {percent['value']} % [{percent['low']}, {percent['high']}] of the samples, on average by "
        f"{peak['mean_difference']['value']:.3f}",
        f"larger than that of the pinned one in {percent['value']} % of the samples",
        only_if(
            above("peak_factor", "traditional", "thin-walled")["share"]["value"] == 1,
            "It is larger than with the thin-walled one in all samples.",
        ),
    ]

    varied = {i["input"]: i for i in s.at("sensitivity/inputs")}
    columns = [(key, r) for key in [sharing, "peak_factor"] for r in ["traditional", "thin-walled"]]
    nominal = [s.number(r, f"sun_planet_{key}") for key, r in columns]
    both = lambda path: [
        [varied[path]["rings"][r][side][f"sun_planet_{key}"] for side in ["divided", "multiplied"]]
        for key, r in columns
    ]
    cells = lambda texts: " | ".join(texts)
    named = {
        "supports.planet_N_per_m": "planet bearing 1e9 N/m",
        "supports.sun_N_per_m": "sun support 1e7 N/m",
        "dynamics.mesh_damping_ratio": "mesh damping 0.07",
    }
    others = [both(path) for path in varied if path not in named]
    change = [max(abs(v - n) for other in others for v in other[i]) for i, n in enumerate(nominal)]
    texts.append(f"| as in the scene | {cells(f'{n:.3f}' for n in nominal)} |")
    for path, title in named.items():
        texts.append(f"| {title} | {cells(f'{low:.3f} … {high:.3f}' for low, high in both(path))} |")
    within = cells(f"within {at_most(c, 4)}" for c in change)
    texts += [
        f"| others (ring and carrier supports, support damping, backlash) | {within} |",
        only_if(
            all(i["order_of_rings_stays"] for i in varied.values()),
            f"The order of the averaged load sharing is the same in all {2 * len(varied)} cases.",
        ),
    ]
    return {"docs/ring_types.md": texts}


def ring_types_variants(s):
    names = {
        "traditional": "traditional",
        "sleeve8p8x18": "sleeve 8.8 mm × 18 mm",
        "sleeve18x10p6": "sleeve 18 mm × 10.6 mm",
        "sleeve40x4p7": "sleeve 40 mm × 4.7 mm",
    }
    texts = []
    for ring in s.figures:
        title = names.get(ring, f"{''.join(c for c in ring if c.isdigit())} pins")
        stiffness = s.number(ring, "ring_planet_mean_stiffness_N_per_m", 1e-6)
        lte = s.number(ring, "ring_planet_lte_peak_to_peak_m", 1e6)
        texts.append(
            f"| {title} | {stiffness:.0f} | {lte:#.3g} | {s.number(ring, 'sun_planet_load_sharing_averaged'):.3f} "
            f"| {s.number(ring, 'sun_planet_peak_factor'):.3f} |".replace(". |", " |")
        )
    none, static = s.columns("pins6/dynamics/rim_coupling.csv")["sun_planet_load_sharing_averaged"][:2]
    share = {pins: f"{coupling(s, f'pins{pins}'):.0f} %" for pins in [12, 9, 6]}
    texts.append(
        f"It is {share[12]} of the mesh compliance with 12 pins, {share[9]} with 9 and {share[6]} with 6, where it "
        f"lowers the averaged coefficient by {none - static:.2f}"
    )
    return {"docs/ring_types.md": texts}


def arc_tooth_2kv(s):
    arc_seconds, per_arc_minute = 180 * 3600 / math.pi, math.pi / 180 / 60
    stiffness = lambda at: s.value(f"{at}vibration/torsional_stiffness/mean_Nm_per_rad", per_arc_minute)
    given, computed = (v["figures"] for v in s.data["variants"])
    bar = lambda key, scale=1: measured(scale * computed[key]["value"], scale * computed[key]["error"])
    first, second = given["frequency_1_Hz"]["value"], given["frequency_2_Hz"]["value"]
    times = s.value("computed/arc_pins/mean_stiffness_N_per_m") / s.value("arc_pins/mean_stiffness_N_per_m")
    motion = lambda key: s.value(f"computed/motion/{key}", arc_seconds)
    forces_of_pins = r"The largest force is ([\d.]+) N. The formula of the paper gives ([\d.]+) N"
    pin_forces = [float(force) for force in s.reported(forces_of_pins)]
    texts = [
        f"| sun mesh, mean, N/µm | {s.value('sun_planet/mean_stiffness_N_per_m', 1e-6):.0f} "
        f"| {s.bar('computed/sun_planet/mean_stiffness_N_per_m', 1e-6)} |",
        f"| arc mesh, mean, N/µm | {s.value('arc_pins/mean_stiffness_N_per_m', 1e-6):.0f} "
        f"| {s.value('computed/arc_pins/mean_stiffness_N_per_m', 1e-6):.0f} |",
        f"| first frequency, Hz | {first:.2f} | {bar('frequency_1_Hz')} |",
        f"| second frequency, Hz | {second:.0f} | {bar('frequency_2_Hz')} |",
        f"| torsional stiffness from the output, N m/arc minute | {stiffness(''):.1f} | {stiffness('computed/'):.1f} |",
        "| output error under load, peak to peak, arc seconds | 0 "
        f"| {bar('output_error_peak_to_peak_rad', arc_seconds)} |",
        f"| the same without inertia | 0 | {bar('output_error_quasi_static_rad', arc_seconds)} |",
        f"({pin_forces[0]:.0f} N and {pin_forces[1]:.0f} N at the even share)",
    ]

    inputs = {i["input"]: i["d_ln_f_per_d_ln_p"] for i in s.at("vibration/first_frequency_inputs")}
    titles = {
        "stage.module_mm": "module",
        "input.inertia_kg_m2": "input inertia",
        "crank.bearing_N_per_m": "crank bearing",
        "arc_gear.eccentricity_mm": "eccentricity",
        "arc_gear.bearing_N_per_m": "arc gear bearing",
        "planet.inertia_kg_m2": "planet inertia",
        "mesh.arc_pins.mean_N_per_m": "arc mesh",
    }
    assumed = [i["key"] for i in s.data["inputs"] if "assumed" in i and i["key"] in inputs]
    for key, title in titles.items():
        power = f"{inputs[key]:+.3f}".replace("-", "−")
        texts.append(f"| {title} | {power} | {'assumed' if key in assumed else 'printed'} |")
    energy = lambda key: f"{200 * inputs[key]:.0f} %"  # the share of a spring is twice its exponent
    known_to = 20 * math.hypot(*(inputs[key] for key in assumed))
    low, high = (s.at(f"monte_carlo/frequency_1_Hz/{q}/value") for q in ["quantile_05", "quantile_95"])
    train = s.at("vibration/one_degree_of_freedom")
    modes = [v for name, v in s.columns("dynamics/modes_over_crank.csv").items() if name.startswith("mode")]
    about_mean = max(max(abs(f - sum(v) / len(v)) for f in v) / (sum(v) / len(v)) for v in modes)
    smallest = min(m["smallest_factor"] for m in s.at("computed/motion/sun_planet"))
    texts += [
        f"| all others | below {at_most(max(abs(p) for key, p in inputs.items() if key not in titles), 3)} | |",
        f"Its inertia seen from the output is {train['train_inertia_at_output_kg_m2']:.3f} kg m²",
        f"The input alone contributes {train['input_inertia_at_output_kg_m2']:.4f} of it",
        f"With the static torsional stiffness of {train['stiffness_Nm_per_rad'] / 1e3:.1f} kN m/rad this gives "
        f"{train['frequency_of_train_Hz']:.2f} Hz.",
        f"{energy('crank.bearing_N_per_m')} of the strain energy is in the crank bearings, "
        f"{energy('arc_gear.bearing_N_per_m')} in those of the arc gears, {energy('mesh.arc_pins.mean_N_per_m')} in "
        "the arc meshes",
        f"{len(assumed)} of the {len(inputs)} inputs are assumed.",
        f"the frequency would be known to {known_to:.0f} %.",
        f"{s.at('monte_carlo/samples')} samples",
        f"spread from {low:.0f} to {high:.0f} Hz (5 and 95 %)",
        f"The difference of {100 * (first / 127 - 1):.0f} % to the measured value corresponds to an input inertia "
        f"{100 * (first / 127 - 1) / -inputs['input.inertia_kg_m2']:.0f} % larger.",
        f"The computed arc stiffness, {times:.1f} times the prescribed one, changes it by "
        f"{100 * (computed['frequency_1_Hz']['value'] / first - 1):.1f} %.",
        f"The exponent of the sun mesh is {inputs['mesh.sun_planet.mean_N_per_m']:.4f}.",
        f"by up to {100 * about_mean:.0f} % about their mean",
        f"at {s.at('operating_point/sun_mesh_frequency_Hz'):.0f} Hz excite the output by "
        f"{motion('output_error_peak_to_peak_rad'):.2f} arc seconds",
        f"Without inertia it would be {motion('output_error_quasi_static_rad'):.3f}",
        f"vary between {smallest:.2f} and {computed['sun_planet_peak_factor']['value']:.2f} times their mean",
    ]
    return {"docs/arc_tooth_2kv.md": texts}


def helical_pair(s):
    um = lambda x: f"{1e6 * x:.3f}"
    errors = s.at("manufacturing_error")
    texts = []
    for title, key in [
        ("T of one gear, one-sided", "pinion_error"),
        ("magnitude of T", "pinion_error_magnitude"),
        ("X₁", "pinion_x1"),
        ("envelope √(X₁² + X₂²), **used**", "pinion_envelope"),
        ("sum of both gears, one-sided", "sum"),
    ]:
        r = errors["readings"][key]
        low_high = f"{um(r['low_m'])} … {um(r['high_m'])}"
        texts.append(f"| {title} | {um(r['sample_m'])} | {low_high} | {um(r['exact_m'])} |")
    drawn = [1e6 * r["sample_m"] for r in errors["readings"].values()]
    have_it = [key for key, r in errors["readings"].items() if r["low_m"] < 13.1e-6 < r["high_m"]]
    base_helix, helix = math.radians(s.at("derived/base_helix_angle_deg")), math.radians(14)
    iso = s.value("mean_stiffness_N_per_m/iso_6336", 1e-6)
    texts += [
        f"Its thrust is {100 * (math.tan(helix) / math.tan(base_helix) - 1):.0f} % too large.",
        f"η₁ = 36/6.8 = {um(errors['eta_1_m'])} µm belongs to F′ − f′, η₂ = {um(errors['eta_2_m'])} µm to f′",
        f"lists {len(drawn)} interpretations between {min(drawn):.1f} and {max(drawn):.1f} µm",
        f"| ISO 6336-1, method B, with ε_α = {s.at('derived/transverse_contact_ratio'):.3f} | {iso:.0f} |",
        only_if(
            have_it == ["pinion_envelope", "wheel_envelope", "sum"],
            "The published 13.1 µm lies within the intervals of the last two",
        ),
        f"The factor between them is cos² β_b, {100 * (1 - math.cos(base_helix) ** 2):.0f} %.",
    ]

    shares = {x["pinion_torque_Nm"] / 1e3: x for x in s.at("transmission_error_shares")}
    alone = lambda torque, cause: 1e6 * shares[torque][f"{cause}_alone_m"]["quasi_static"]
    deflection = lambda torque: 1e6 * shares[torque]["load_deflection_m"]
    causes = {round(x["pinion_speed_rpm"]): x for x in s.at("causes_over_speed")}
    acceleration = lambda speed, cause: causes[speed][f"{cause}_alone"]["acceleration_m_per_s2"]
    strongest = max(causes, key=lambda speed: acceleration(speed, "errors"))
    frequencies = [f for f in s.at("response/natural_frequencies_Hz") if f > 0]
    met_at = lambda frequency: f"{1500 * frequency / s.at('derived/mesh_frequency_Hz'):.0f} r/min"
    grid = s.columns("dynamics/grid_1.csv")
    torques, speeds, loss = (grid[k] for k in ["stage_pinion_torque_Nm", "stage_pinion_speed_rpm", "contact_loss"])
    slow = [i for i, speed in enumerate(speeds) if speed == min(speeds)]
    over_torque = lambda key, scale: [f"{scale * grid[key][i]:.0f}" for i in [slow[0], slow[-1]]]
    apart = [torque for torque, lost in zip(torques, loss) if lost > 0]
    texts += [
        f"the errors alone cause {alone(20, 'errors'):.1f} µm peak to peak at every load",
        f"The ripple of the stiffness causes {alone(1, 'stiffness'):.2f} µm at 1 kN m, {alone(20, 'stiffness'):.1f} µm "
        f"at 20 kN m and {alone(50, 'stiffness'):.1f} µm at 50 kN m",
        f"It is {deflection(1):.1f} µm at 1 kN m, less than the amplitude of the errors, but {deflection(50):.0f} µm "
        "at 50 kN m.",
        f"From {min(t for t in shares if deflection(t) > alone(t, 'errors') / 2):.0f} kN m on the largest",
        f"the peak-to-peak value is {s.value('response/transmission_error/peak_to_peak_m', 1e6):.1f} µm",
        f"The errors cause {100 * shares[50]['error_share']['dynamic']:.0f} % of it at 50 kN m with the assumed ripple",
        "({} to {} kN, {} to {} µm from 2.5 to 50 kN m)".format(
            *over_torque("mesh_force_max_N", 1e-3), *over_torque("transmission_error_max_m", 1e6)
        ),
        f"up to the mesh mode at {frequencies[4]:.0f} Hz, which the mesh frequency meets at {met_at(frequencies[4])}.",
        f"Four modes of the bearings between {frequencies[0]:.0f} and {frequencies[3]:.0f} Hz are met from "
        f"{met_at(frequencies[0])} on.",
        f"the acceleration is {s.value('response/acceleration_m_per_s2/tooth'):.0f} m/s² with the assumed ripple",
        f"Up to {max(apart) / 1e3:.0f} kN m the teeth lose contact near resonance ({len(apart)} of {len(loss)} points "
        "of the grid).",
        f"({acceleration(100, 'errors'):.2f} against {acceleration(100, 'stiffness'):.2f} m/s² at 100 r/min, "
        f"{acceleration(strongest, 'errors'):.0f} against {acceleration(strongest, 'stiffness'):.0f} m/s² at "
        "resonance)",
    ]
    return {"docs/helical_pair.md": texts}


def helical_pair_solid(s):
    closed = s.changed("mesh.pinion_wheel.stiffness=closed_form")
    cycle = closed.columns("stiffness_pinion_wheel.csv")
    load = closed.at("derived/transverse_force_N")
    secant = [k for k, at in zip(cycle["stiffness_secant_N_per_m"], cycle["load_N"]) if abs(at / load - 1) < 1e-6]
    closed_ripple = 50 * (max(secant) - min(secant)) / (sum(secant) / len(secant))
    mean = lambda source: s.value(f"mean_stiffness_N_per_m/{source}", 1e-6)
    shares = {x["pinion_torque_Nm"] / 1e3: x for x in s.at("transmission_error_shares")}
    slow = next(x for x in closed.at("causes_over_speed") if round(x["pinion_speed_rpm"]) == 200)
    alone = lambda cause: slow[f"{cause}_alone"]["acceleration_m_per_s2"]
    unknown = r"From order (\d) on they are smaller than the estimated error of the table \(±([\d.]+) µm\)"
    order, error = s.reported(unknown)
    return {
        "docs/helical_pair.md": [
            f"| closed form of the transverse section, staggered along the helix | {mean('closed_form'):.0f} "
            f"| ±{closed_ripple:.1f} % |",
            f"| finite elements, solid | {s.bar('mean_stiffness_N_per_m/computed', 1e-6)} "
            f"| ±{s.number('', 'pinion_wheel_stiffness_ripple', 50):.1f} % |",
            f"The formula is {100 * (mean('iso_6336') / mean('computed') - 1):.0f} % above the finite elements",
            f"(finite elements: {1e6 * shares[20]['stiffness_alone_m']['quasi_static']:.1f} µm at 20 kN m)",
            f"{100 * shares[40]['error_share']['dynamic']:.0f} % at 40 kN m with the computed one",
            f"{s.bar('response/acceleration_m_per_s2/tooth')} m/s² with the computed one",
            f"{alone('stiffness'):.1f} m/s² against {alone('errors'):.1f} of the error at 200 r/min",
            f"those from order {order} on",
            f"smaller than its estimated error of {error} µm",
        ]
    }


def backlash_optimisation(s):
    def coefficients(table):
        """Ω_s, Ω_r and Ω of every row."""
        sun, ring = (table[f"{mesh}_planet_load_sharing_instantaneous"] for mesh in ["sun", "ring"])
        return [(a, b, (a + b) / 2) for a, b in zip(sun, ring)]

    def given(run):
        figures = run.at("optimise/given/figures")
        return coefficients({key: [value] for key, value in figures.items()})[0]

    def searched(run):
        tables = [run.columns(f"held/dynamics/optimise/{search}_1.csv") for search in ["genetic", "cma_es"]]
        omega = [row[2] for table in tables for row in coefficients(table)]
        return max(omega) - min(omega)

    backlash, speed, lag = (s.columns(f"held/dynamics/sweep_{i}.csv") for i in [1, 2, 3])
    cells = lambda row, decimals: " | ".join(f"{x:.{decimals}f}" for x in row)
    best, worst = (lambda table, f=f: f(coefficients(table), key=lambda row: row[2]) for f in [min, max])
    at = lambda table, row: {key: values[coefficients(table).index(row)] for key, values in table.items()}
    speed_of = lambda row: f"{at(speed, row)['stage_sun_speed_rpm']:.0f} r/min"
    lag_of = lambda row: f"{at(lag, row)['mesh_ring_planet_phase']:g} of a cycle"
    open_at = lambda i: f"{100 * speed['ring_planet_contact_loss'][i]:.0f} %"
    fast = speed["stage_sun_speed_rpm"].index(5200)
    fast_run = s.changed("stage.sun_speed_rpm=5200", "optimise.generations=10")
    tried = fast_run.at("optimise/given/initial_conditions")
    averaged = s.at("rings/held/load_sharing/sun_planet/averaged")
    heavy = given(s.changed("planet.mass_kg=0.86"))
    sweep = [row[2] for row in coefficients(backlash)]
    return {
        "docs/backlash_optimisation.md": [
            only_if(max(sweep) - min(sweep) < 1e-12, f"It is {sweep[0]:.3f} with 50, 300 and 820 µm"),
            only_if(searched(s) < 1e-12, "Over all designs of both searches it changes by rounding alone."),
            only_if(s.at("optimise/flat"), 'The report states "Nothing to gain."'),
            f"At 5200 r/min the ring meshes are open for {open_at(fast)} of the time.",
            f"moves by {1e6 * speed['ring_planet_deflection_peak_to_peak_m'][fast]:.1f} µm",
            only_if(searched(fast_run) < 1e-5, f"Ω = {given(fast_run)[2]:.3f} changes by less than 1e-5"),
            only_if(tried["tried"] == 6 and tried["motions"] == 1, "Six initial conditions lead to one motion."),
            f"alone changes it from {best(lag)[2]:.3f} to {worst(lag)[2]:.3f}, the speed between 500 and 6000 r/min "
            f"from {best(speed)[2]:.3f} to {worst(speed)[2]:.3f}.",
            f"| any backlash, no lag of the ring mesh | {cells(given(s), 4)} |",
            f"| lag of the ring mesh {lag_of(best(lag))}: the smallest | {cells(best(lag), 3)} |",
            f"| {lag_of(worst(lag))}: the largest | {cells(worst(lag), 3)} |",
            f"| {speed_of(best(speed))}: the smallest | {cells(best(speed), 3)} |",
            f"| {speed_of(worst(speed))}: the largest, ring meshes open "
            f"{open_at(coefficients(speed).index(worst(speed)))} of the time | {cells(worst(speed), 3)} |",
            f"({averaged['value']:.3f} ± {averaged['error']:.3f} as sampled)",
            f"Ω_s is {heavy[0]:.3f} and Ω_r {heavy[1]:.3f}",
        ]
    }


def tip_relief_optimisation(s):
    given, best = (s.at(f"optimise/{which}") for which in ["given", "best"])
    found = "traditional/dynamics/optimise/best.toml"
    after = s.changed("model=automatic", scene=found)
    before = s.changed("model=automatic", *(f"{key}={x:g}" for key, x in given["inputs"].items()), scene=found)

    def row(title, key):
        formulas = " | ".join(f"{design['figures'][key]:.3f}" for design in [given, best])
        return f"| {title} | {formulas} | {before.result('traditional', key)} | {after.result('traditional', key)} |"

    reliefs = [f"{best['inputs'][f'{gear}.tip_relief_um']:.0f}" for gear in ["sun", "planet", "ring"]]
    uneven = lambda design: design["figures"]["sun_planet_load_sharing_averaged"] - 1
    cma_es, genetic = s.at("optimise/searches")
    return {
        "docs/backlash_optimisation.md": [
            row("load sharing, averaged over a mesh cycle", "sun_planet_load_sharing_averaged"),
            row("load sharing, instantaneous", "sun_planet_load_sharing_instantaneous"),
            row("largest peak factor", "sun_planet_peak_factor"),
            f"evaluate {cma_es['evaluations'] + genetic['evaluations']} designs",
            only_if(
                best["inputs"]["supports.planet_N_per_m"] < 1.02 * 3e8,
                f"({reliefs[0]}, {reliefs[1]} and {reliefs[2]} µm, and the softest bearings allowed)",
            ),
            f"remove {100 * (1 - uneven(best) / uneven(given)):.0f} % of the uneven load",
            f"After {cma_es['evaluations_to_best']} designs CMA-ES is within {s.at('optimise/least_meaning'):.3f} of "
            "its best",
            f"The genetic algorithm ends at {genetic['best']:.3f} against {cma_es['best']:.3f}.",
        ]
    }


def five_planets(s):
    thick, thin = "rim_12_mm", "rim_4_mm"
    sharing = "sun_planet_load_sharing_averaged"
    row = lambda run, title, key, scale=1: f"| {title} | {run.result(thick, key, scale)} | {run.result(thin, key, scale)} |"
    stress = "ring_planet_ring_rim_von_mises_Pa"
    thinner = s.changed("ring.rim_4_mm.rim_thickness_mm=2.5")
    better = s.changed("errors.planet_pin_position_error_um[1]=35")
    gain = s.number(thick, sharing) - s.number(thin, sharing)
    errors = [f"{s.figures[rim][sharing]['error']:.3f}" for rim in [thick, thin]]
    return {
        "docs/thin_ring_of_a_car.md": [
            row(s, "mean stiffness of the ring mesh, N/µm", "ring_planet_mean_stiffness_N_per_m", 1e-6),
            row(s, "load sharing K_γ of the sun meshes", sharing),
            row(s, "peak factor of the sun meshes", "sun_planet_peak_factor"),
            row(s, "rim stress (von Mises), MPa", stress, 1e-6),
            f"**K_γ is {s.number(thick, sharing):.2f}.**",
            only_if(errors == ["0.003"] * 2, f"lowers K_γ by {gain:.3f}.** The errors are 0.003 each"),
            only_if(3.5 < s.number(thin, stress) / s.number(thick, stress) < 4.5, "which is four times as large"),
            f"K_γ falls to {thinner.result(thin, sharing)}, and the rim stress rises to "
            f"{thinner.result(thin, stress, 1e-6)} MPa.",
            f"K_γ of the ring with the 12 mm rim falls to {better.result(thick, sharing)}.",
        ]
    }


def from_a_drawing(s):
    drawing = json.loads(s.command("geometry", "--json"))
    geometry, backlash = drawing["gears"], [pair["normal_backlash_um"] for pair in drawing["pairs"].values()]
    gears = ["sun", "planet", "ring 'ring'"]
    row = lambda title, key, digits: f"| {title} | " + " | ".join(f"{geometry[g][key]:.{digits}f}" for g in gears) + " |"
    assemblies = s.at("rings/ring/load_sharing_of_assemblies")
    part = {c["tolerance"]: c for c in assemblies["contributions"]}
    contribution = lambda key: f"{part[key]['alone']['p95']['value']:.3f} | {part[key]['without']['p95']['value']:.3f}"
    unmoved = all(part[f"{body}_eccentricity"]["alone"]["p95"]["value"] < 1 + 1e-9 for body in ["sun", "ring"])
    return {
        "docs/drawing_to_load_sharing.md": [
            row("profile shift x", "profile_shift", 5),
            row("dimension over pins (ring: between), mm", "over_pins_mm", 4),
            "The normal backlash is {:.2f} µm in the sun mesh and {:.2f} µm in the ring mesh.".format(*backlash),
            f"half of them below | {s.result('ring', 'load_sharing_of_assemblies_p50')} |",
            f"95 % of them below | {s.result('ring', 'load_sharing_of_assemblies_p95')} |",
            f"| dynamic factor K_V of the sun meshes | {s.result('ring', 'sun_planet_dynamic_factor')} |",
            f"**K_γ of the series is {s.number('ring', 'load_sharing_of_assemblies_p95'):.2f}.**",
            f"| position of the planet pins | {contribution('planet_pin_position')} |",
            f"| runout of the planets | {contribution('planet_eccentricity')} |",
            only_if(unmoved, "The runout of sun and ring contributes nothing, because the sun floats and follows it."),
        ]
    }


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
        five_planets,
        from_a_drawing,
    ]
}


def main(arguments):
    if arguments == ["--list"]:
        print("\n".join(SCENES))
        return 0
    program, source, scene, out = arguments[0], pathlib.Path(arguments[1]), arguments[2], pathlib.Path(arguments[3])
    errors = 0
    (file,) = [*source.glob(f"data/scenes/{scene}.toml"), *source.glob(f"data/cases/*/{scene}.toml")]
    for page, texts in SCENES[scene](Run(program, file, out)).items():
        content = folded((source / page).read_text(encoding="utf-8"))
        missing = [text for text in texts if folded(text) not in content]
        for text in missing:
            print(f"{page} does not have the text that {file.name} gives:\n  {text}")
        print(f"{len(texts) - len(missing)} of {len(texts)} texts of {page} are those of {scene}")
        errors += len(missing)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
