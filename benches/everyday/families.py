"""All kinds of scenes by name, those with answers and those with a relation to another, and the judgement of one of them."""

import column
import digging
import dipping
import footing
import ground
import motion
import relations
import slope
import walls
import water
from scene import RIGHT, SAID, SILENT, Dice, run, verdict

# Functions of a Dice that return a Scene.
ANSWERS = {
    "rest": ground.rest,
    "gravity": ground.gravity,
    "dig": digging.dig,
    "dipping": dipping.dipping,
    "dipping_rest": dipping.dipping_rest,
    "slope_rest": dipping.slope_rest,
    "oedometer_load": column.load,
    "oedometer_plate": column.plate,
    "oedometer_curve": column.curve,
    "self_weight": column.self_weight,
    "undrained": column.undrained,
    "strip_load": column.strip_load,
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
    "heap": slope.heap,
    "fall": motion.fall,
    "landing": motion.landing,
    "impact": motion.impact,
    "incline": motion.incline,
}
RELATIONS = relations.RELATIONS
KINDS = {name: make.__doc__ for name, make in ANSWERS.items()} | {name: f"The same result: {make.__doc__[0].lower()}{make.__doc__[1:]}" for name, (make, _) in RELATIONS.items()}


def judge(name, seed, folder):
    """What a scene is about, its verdict and remarks; it is run in a folder."""
    dice = Dice(seed)
    if name in ANSWERS:
        scene = ANSWERS[name](dice)
        result = run(scene, folder)
        return scene.about, *verdict(result, lambda: scene.answers(result))
    relate, of = RELATIONS[name]
    family = dice.choice(of)
    scene = relations.instrumented(ANSWERS[family](dice))
    other, tolerance, of_other = relate(dice, scene)
    about = f"{family}: {scene.about}"
    results = [run(scene, folder / "one"), run(other, folder / "other", dice.randint(1, 5) if name == "resumed" else None)]
    endings = [verdict(result, list) for result in results]
    worst = next((ending for ending in endings if ending[0] not in (RIGHT, SAID)), None) or next((ending for ending in endings if ending[0] == SAID), None)
    if worst is not None:
        return about, worst[0], worst[1]
    wrong = [str(check) for check in relations.compared(*results, tolerance, of_other) if not check.right]
    if not tolerance and (results[0].out / "history.csv").read_bytes() != (results[1].out / "history.csv").read_bytes():
        wrong.append("history.csv differs")
    if not wrong:
        return about, RIGHT, []
    said = [f"warning: {line}" for result in results for line in result.warnings]
    return about, (SAID if said else SILENT), wrong + said
