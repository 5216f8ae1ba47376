"""All families of scenes by name, and the judgement of one of them."""

import column
import ground
from scene import Dice, run, verdict

# Functions of a Dice that return a Scene.
FAMILIES = {
    "rest": ground.rest,
    "gravity": ground.gravity,
    "dipping": ground.dipping,
    "dipping_rest": ground.dipping_rest,
    "oedometer_load": column.load,
    "oedometer_plate": column.plate,
    "oedometer_curve": column.curve,
    "self_weight": column.self_weight,
}


def judge(name, seed, folder):
    """What a scene is about, its verdict and remarks; it is run in a folder."""
    scene = FAMILIES[name](Dice(seed))
    result = run(scene, folder)
    return scene.about, *verdict(result, lambda: scene.answers(result))
