"""How uncertain coefficients spread the trim and the roots of the rigid COM, and which of them matter."""

import ahv


def main() -> None:
    """Print the spread of each quantity, and the five parameters that move the angle of attack most."""
    drawn = ahv.com_rigid.disperse(members=300, seed=1)
    print(drawn)
    print(drawn.to_pandas()[["name", "part", "unit", "nominal", "mean", "std", "p05", "p95"]].round(5))
    matter = drawn.sensitivities()
    alpha = matter[matter["name"] == "alpha"]
    print(alpha.reindex(alpha["effect"].abs().sort_values(ascending=False).index).head())


if __name__ == "__main__":
    main()
