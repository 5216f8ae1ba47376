"""The strip footing: pressure over settlement beside Prandtl's limit, 2 + pi times the strength.

    python paraview/strip_footing.py [OUT] [-o PICTURE] [--width B --strength S]

B is the length of the loaded edge of the model in m (half the footing where the model is a half) and S the
undrained strength in kPa; without them the reaction is drawn as it is. Reads `history.csv`.
To look at the mechanism in ParaView: `paraview OUT/points.pvd`, colour by `plastic_strain [-]`.
"""

import math

from common import arguments, chart, history, quantity


def main():
    given = arguments("strip_footing", __doc__.split("\n")[0], width="length of the loaded edge [m]",
                      strength="undrained strength [kPa]")
    table = history(given.out / "history.csv")
    settlement_name, settlement = quantity(table, "uy")
    reaction_name, reaction = quantity(table, "reaction_y")
    reaction = abs(reaction)
    levels = ()
    if given.width and given.strength:
        reaction, reaction_name = reaction / (given.width * given.strength), "pressure / strength [-]"
        levels = ((2 + math.pi, "2 + pi (Prandtl)"),)
    chart(given.picture, "Strip footing", -settlement, reaction, f"settlement, -{settlement_name}", reaction_name,
          levels)


if __name__ == "__main__":
    main()
