"""All families of scenes by name, and the judgement of one of them."""

import column
import footing
import ground
import motion
import slope
import walls
import water
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
    "consolidation": water.consolidation,
    "submerged": water.submerged,
    "sunken": water.sunken,
    "rankine": walls.rankine,
    "janssen": walls.janssen,
    "shaft": walls.shaft,
    "footing_clay": footing.clay,
    "footing_friction": footing.friction,
    "infinite_slope": slope.infinite,
    "safety": slope.safety,
    "fall": motion.fall,
    "impact": motion.impact,
    "incline": motion.incline,
}


def judge(name, seed, folder):
    """What a scene is about, its verdict and remarks; it is run in a folder."""
    scene = FAMILIES[name](Dice(seed))
    result = run(scene, folder)
    return scene.about, *verdict(result, lambda: scene.answers(result))
