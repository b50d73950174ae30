"""Trims of the DCOM over velocity, and how its poles move: a picture, and a table for pandas."""

import sys
from pathlib import Path

import ahv
import matplotlib as mpl

mpl.use("agg")
import matplotlib.pyplot as plt
import pandas as pd


def main(out: Path) -> None:
    """Write poles.png and trims.csv into a folder."""
    rows, axes = [], plt.subplots(figsize=(5.6, 4.2))[1]
    for velocity in range(7400, 8401, 200):
        trim = ahv.dcom.trim(velocity=float(velocity))
        system = ahv.dcom.linearize(trim)
        poles = system.poles()
        fastest = max(pole.value.real for pole in poles)
        rows.append({"velocity": velocity, **dict(trim.input), "alpha": trim.state.alpha, "rightmost": fastest})
        slow = [pole.value for pole in poles if pole.mode == "short period"]
        axes.plot([it.real for it in slow], [it.imag for it in slow], "x", label=f"{velocity} ft/s")
    axes.set(title="short period of the DCOM", xlabel="real part, 1/s", ylabel="imaginary part, rad/s")
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.legend(fontsize=7, frameon=False)
    axes.figure.tight_layout()
    axes.figure.savefig(out / "poles.png", dpi=120)
    table = pd.DataFrame(rows).set_index("velocity")
    table.to_csv(out / "trims.csv")
    print(table)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
