"""Frames of several series over the exact run: what each frame is."""
import csv
import subprocess

# colour, point of gnuplot, words: told apart in grey print too
looks = {"same": ("#1f4e79", 7, "on the exact list"), "elsewhere": ("#c55a11", 8, "another equilibrium"), "soft": ("#7f7f7f", 2, "soft list"),
         "moving": ("#c00000", 4, "in motion"), "undecided": ("#000000", 1, "undecided")}
kinds = {"early": "elsewhere", "late": "elsewhere", "other": "elsewhere", "refuted": "undecided", "file": "undecided"}


def strain(frame):
    """Of the true vertex, if it has one."""
    return float(frame["eps2"] if frame["true_eps2"] == "nan" else frame["true_eps2"])


def panel(name, folder):
    """The lines of gnuplot for one series, with its data in them."""
    frames = list(csv.DictReader(open(folder / "comparison.csv")))
    loads = [float(f["sigma2"]) for f in frames]
    margin = 0.05 * (max(loads) - min(loads)) + 1e-3
    stairs, strains = "", [strain(f) for f in frames]
    for row in csv.DictReader(open(folder / "path.csv")): # level parts are rearrangements
        if float(row["sigma2"]) <= max(loads) + margin:
            stairs += f"{strains[-1]} {row['sigma2']}\n" if stairs else ""
            strains.append(float(row["eps2"]))
            stairs += f"{strains[-1]} {row['sigma2']}\n"
    stairs += f"{strains[-1]} {max(loads) + margin}\n"
    plots, blocks = ['$exact with lines lw 2 lc "#a6bcd6" title "exact run"'], f"$exact << EOD\n{stairs}EOD\n"
    for kind, (colour, point, words) in looks.items():
        here = [f for f in frames if kinds.get(f["status"], f["status"]) == kind]
        if here:
            blocks += f"${kind} << EOD\n" + "".join(f"{strain(f)} {f['sigma2']}\n" for f in here) + "EOD\n"
            plots.append(f'${kind} with points pt {point} lc "{colour}" title "{words}"')
    wide = max(max(strains) - min(strains), 1e-6)
    return blocks + (f'set title "{name}"\nset xrange [{min(strains) - 0.05 * wide}:{max(strains) + 0.05 * wide}]\nset xtics {wide / 3:.0e}\n'
                     f'set yrange [{min(loads) - margin}:{max(loads) + margin}]\nplot {", ".join(plots)}\n')


def draw(output, series, rows):
    """OUTPUT/ensemble.svg: a panel for each (name, folder of a comparison), so many rows of them."""
    script = (f'set terminal svg size 1000,{360 * rows} dynamic font "sans,13" background "#ffffff"\nset output "ensemble.svg"\n'
              f'set multiplot layout {rows},{-(-len(series) // rows)}\nset grid\nset key right bottom\nset xlabel "strain ε_2"\n'
              'set ylabel "σ_2"\n' + "".join(panel(*one) for one in series) + "unset multiplot\n")
    (output / "ensemble.gp").write_text(script)
    subprocess.run(["gnuplot", "ensemble.gp"], cwd=output, check=True)
