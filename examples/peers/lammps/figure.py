"""Frames of several series over the exact run: what each frame is."""
import csv
import subprocess

# colour, point of gnuplot, words: told apart in grey print too
looks = {"same": ("#1f4e79", 7, "on the exact list"), "elsewhere": ("#c55a11", 8, "another equilibrium"), "soft": ("#7f7f7f", 2, "soft list"),
         "moving": ("#c00000", 4, "in motion"), "undecided": ("#000000", 1, "undecided")}
kinds = {"early": "elsewhere", "late": "elsewhere", "other": "elsewhere", "refuted": "undecided", "file": "undecided"}


def panel(name, folder):
    """The lines of gnuplot for one series, with its data in them."""
    data, last = "", None
    for row in csv.DictReader(open(folder / "path.csv")): # level parts are rearrangements
        if last is not None:
            data += f"{last} {row['sigma2']}\n"
        last = float(row["eps2"])
        data += f"{last} {row['sigma2']}\n"
    frames = list(csv.DictReader(open(folder / "comparison.csv")))
    plots = ['$exact with lines lw 2 lc "#a6bcd6" title "exact run"']
    blocks = f"$exact << EOD\n{data}EOD\n"
    for kind, (colour, point, words) in looks.items():
        here = [f for f in frames if kinds.get(f["status"], f["status"]) == kind]
        if here:
            rows = "".join(f"{f['eps2'] if f['true_eps2'] == 'nan' else f['true_eps2']} {f['sigma2']}\n" for f in here)
            blocks += f"${kind} << EOD\n{rows}EOD\n"
            plots.append(f'${kind} with points pt {point} lc "{colour}" title "{words}"')
    loads = [float(f["sigma2"]) for f in frames]
    margin = 0.05 * (max(loads) - min(loads)) + 1e-3
    return (blocks + f'set title "{name}"\nset yrange [{min(loads) - margin}:{max(loads) + margin}]\nplot {", ".join(plots)}\n')


def draw(output, series, rows):
    """OUTPUT/ensemble.svg: a panel for each (name, folder of a comparison), so many rows of them."""
    script = (f'set terminal svg size 1000,{360 * rows} dynamic font "sans,13" background "#ffffff"\nset output "ensemble.svg"\n'
              f'set multiplot layout {rows},{-(-len(series) // rows)}\nset grid\nset key right bottom\nset xlabel "strain ε_2"\n'
              'set ylabel "σ_2"\n' + "".join(panel(*one) for one in series) + "unset multiplot\n")
    (output / "ensemble.gp").write_text(script)
    subprocess.run(["gnuplot", "ensemble.gp"], cwd=output, check=True)
