"""Plots with Matplotlib; each returns its axes."""

import matplotlib.pyplot as plt


def _axes(axes):
    return axes if axes is not None else plt.subplots()[1]


def plot_stiffness(arrays, load_N=None, axes=None):
    """Mesh stiffness (read_stiffness) over the mesh cycles, at the tabulated load nearest to `load_N`, else the middle
    one."""
    axes = _axes(axes)
    loads = arrays["load_N"]
    load = loads[len(loads) // 2] if load_N is None else loads.sel(load_N=load_N, method="nearest")
    for position, angle in enumerate(arrays["ring_angle_deg"]):
        curve = arrays["stiffness_secant_N_per_m"].sel(load_N=load, ring_angle_deg=angle)
        axes.plot(curve["mesh_phase"] + position, curve / 1e9, color="C0")
    axes.set(xlabel="mesh cycles", ylabel="stiffness, kN/µm", title=f"at {float(load) / 1e3:.4g} kN")
    return axes


def plot_figure(results, key, axes=None):
    """A result of all variants, with its errors."""
    axes = _axes(axes)
    rows = results.figures.xs(key, level="key")
    axes.errorbar(range(len(rows)), rows["value"], rows["error"].fillna(0), fmt="o", capsize=4)
    axes.set_xticks(range(len(rows)), rows.index)
    unit = rows["unit"].iloc[0]
    axes.set(ylabel=rows["title"].iloc[0] + (f", {unit}" if unit else ""))
    return axes


def plot_study(table, key, axes=None):
    """A result over the one varied input of a study, a curve with errors for each variant."""
    axes = _axes(axes)
    inputs = [name for name in table.index.names if name != "variant" and table.index.unique(name).size > 1]
    if len(inputs) != 1:
        raise ValueError(f"a plot needs one varied input, not {len(inputs)} ({', '.join(inputs)}): select with .xs")
    found = table[table["failure"] == ""]
    for variant, rows in found.groupby(level="variant"):
        x = rows.index.get_level_values(inputs[0])
        axes.errorbar(x, rows[key], rows[key + "_error"].fillna(0), marker="o", capsize=3, label=variant or None)
    axes.set(xlabel=inputs[0], ylabel=key)
    if found.index.unique("variant").size > 1:
        axes.legend()
    return axes
