"""Bodies in motion: free fall and landing, a bar that hits a wall, a block on an incline."""

import math

import numpy as np
from geometry import Face, Section, box
from ground import G, oedometer
from scene import Check, Scene, below, near, typed


def fall(dice):
    """A block falls on a floor: gt²/2 before it lands; then it is above the floor, and no energy has come from nowhere."""
    width, height = dice.number(0.3, 1, 2), dice.number(0.3, 1, 2)
    drop = dice.number(0.2, 1.5, 2)
    h = typed(min(width, height) / dice.choice([3, 4, 5]), 2)
    room = dice.number(0.3, 1, 2) * width
    x0, x1 = room, room + width
    # What splashes up the sides is as fast as the fall or faster: it needs room above the block.
    section = _above_floor(width, height, drop, (room, room, 2 * (drop + height)), h, dice.chance(0.3))
    soil = {"model": "linear_elastic", "young": dice.scale(2000, 50000), "poisson": dice.number(0.1, 0.4, 2), "density": dice.number(1.5, 2.2, 2)}
    if dice.chance(0.4):
        soil |= {"model": "mohr_coulomb", "cohesion": dice.choice([1, 5, 20]), "friction": 30}
    elif dice.chance(0.3):
        soil |= {"model": "tresca", "shear_strength": dice.choice([5, 20]), "poisson": 0.49}
    landing = math.sqrt(2 * drop / G)
    step = typed(landing / dice.choice([20, 40]), 2)
    case = {
        "geometry": "plane_strain",
        "regions": {"air": {"kind": "buffer"}, "block": {"kind": "mpm", "material": "soil"}},
        "materials": {"soil": soil},
        "supports": {"sides": {"ux": 0}},
        "gravity": {"y": -G},
        "phases": [{"name": "fall", "analysis": "dynamic", "duration": typed(1.4 * landing), "step": {"initial": step}}],
        "output": {"fields": ["stress", "displacement", "velocity"], "history": [{"name": "block", "on": "block", "quantities": ["uy", "vy"]}]},
    }
    floor = dice.choice(["support", "support", "wall"])
    if floor == "support":
        case["supports"] |= {"floor": dice.choice([{"ux": 0, "uy": 0}, {"uy": 0}])}
    else:
        case["contacts"] = [{"wall": "floor", "soil": "block", "friction": dice.choice([0, 0.3])}]
    weight = width * height * soil["density"] * G

    def drag(end):
        """The way [m] that the empty cells below the block, compressed from step to step, keep it from falling until then.

        They have 1e-5 of the stiffness of the soil, E or that of its inertia in a step, ρd²(1 − α_m)/(βΔt²), d the diagonal of a cell
        (docs/theory.md, 5 and 8; α_m = 0.421, β = 0.277 at the spectral radius of 0.9), and go on to both sides.
        """
        time = np.linspace(0, end, 1001)
        stiffness = 1e-5 * min(soil["young"], soil["density"] * 2 * h**2 * 0.579 / 0.277 / step**2)
        braked = stiffness * (x1 + room) / width * G * time * step / (drop - G * time**2 / 2) / (soil["density"] * height)
        slower = np.cumsum(braked) * end / 1000
        return np.sum(slower) * end / 1000

    def answers(result):
        time, way = result.history["time"], result.history["block.uy"]
        # A cell before the floor its nodes already hold the body.
        free = time < math.sqrt(2 * max(drop - 1.5 * h, 0) / G)
        checks = [
            below("way of the fall less gt²/2, at most", abs(way[free] + G * time[free] ** 2 / 2).max(initial=0), drag(time[free].max(initial=0)) + 1e-7 * drop),
            below("depth of the lowest point below the floor", -result.soil.place[:, 1].min(), 0.05 * h),
            # It is stopped by the floor: half of its height at the most goes into its compression.
            below("depth that its centre fell", -way.min(), drop + height / 2),
        ]
        checks.append(below("gain of energy over that of the fall", result.gain.max() / (weight * drop), 0.02))
        return checks

    return Scene(section, case, answers, f"{soil['model']}, {floor}", 1 if dice.chance(0.3) else 2)


def _above_floor(width, height, drop, room, h, quadrangles):
    """A block above a floor between two sides; `room` is that to its left, to its right, and the height of the lid above the floor."""
    left, right, lid = room
    x0, x1, end = left, left + width, left + width + right
    faces = [
        Face("air", box(0, x0, drop, drop + height), h),
        Face("block", box(x0, x1, drop, drop + height), h),
        Face("air", box(x1, end, drop, drop + height), h),
        Face("air", [(0, 0), (end, 0), (end, drop), (x1, drop), (x0, drop), (0, drop)], h),
        Face("air", [(0, drop + height), (x0, drop + height), (x1, drop + height), (end, drop + height), (end, lid), (0, lid)], h),
    ]
    curves = {"floor": [((0, 0), (end, 0))], "sides": [((x, 0), (x, lid)) for x in (0, end)], "lid": [((0, lid), (end, lid))]}
    return Section(faces, curves, quadrangles=quadrangles)


def landing(dice):
    """A soft block lands at 1 to 10 m/s, also beside a wall: no energy comes from nowhere, or the run says so."""
    width, height = dice.number(0.3, 1, 2), dice.number(0.3, 1, 2)
    h = typed(min(width, height) / dice.choice([3, 4, 5]), 2)
    drop, speed = typed(dice.choice([1.2, 2, 3]) * h, 2), dice.number(1, 10, 2)
    left = typed(dice.choice([0.1, 0.5, 1, 4]) * h, 2)
    density = dice.number(1.5, 2.2, 2)
    young = typed(density * speed**2 * dice.scale(3, 300), 2)
    soil = {"model": "linear_elastic", "young": young, "poisson": dice.choice([0, 0.3, 0.45, 0.49]), "density": density}
    strength = typed(young / dice.choice([20, 100, 500]), 2)
    soil |= dice.choice([{}, {"model": "mohr_coulomb", "cohesion": strength, "friction": 30}, {"model": "tresca", "shear_strength": strength}])
    case = {
        "geometry": "plane_strain",
        "regions": {"air": {"kind": "buffer"}, "block": {"kind": "mpm", "material": "soil"}},
        "materials": {"soil": soil},
        "supports": {"sides": {"ux": 0}, "lid": {"uy": 0}},
        "gravity": {"y": -G},
        "initial_velocity": {"block": {"velocity": {"y": -speed}}},
        "phases": [{"name": "fall", "analysis": "dynamic", "duration": typed((drop + 2 * height) / speed, 2), "step": {"initial": typed(h / speed / dice.choice([2, 4, 10]), 2)}}],
        "output": {"history": [{"name": "block", "on": "block", "quantities": ["uy", "vy"]}]},
    }
    floor = dice.choice(["support", "support", "wall"])
    if floor == "support":
        case["supports"] |= {"floor": dice.choice([{"ux": 0, "uy": 0}, {"uy": 0}])}
    else:
        case["contacts"] = [{"wall": "floor", "soil": "block", "friction": dice.choice([0, 0.3])}]
    first = width * height * density * (speed**2 / 2 + G * drop)

    def answers(result):
        return [below("gain of energy over that of the fall", result.gain.max() / first, 0.01)]

    section = _above_floor(width, height, drop, (left, 2 * width + 1, drop + 6 * height), h, dice.chance(0.5))
    return Scene(section, case, answers, f"{soil['model']}, {floor}", dice.choice([1, 2, 2]))


def impact(dice):
    """An elastic bar hits a wall: its force is ρcv until the wave returns, its momentum is gone after L/c."""
    length, depth = dice.scale(0.5, 20), 1.0
    h = length / dice.choice([20, 30])
    depth = typed(h * dice.choice([1, 2, 3]), 3)
    soil = {"model": "linear_elastic", "young": dice.scale(1e3, 1e7), "poisson": dice.number(0, 0.4, 2), "density": dice.number(1, 8, 2)}
    speed_of_sound = math.sqrt(oedometer(soil) / soil["density"])
    speed = typed(speed_of_sound * dice.scale(1e-5, 1e-3))
    section = Section(
        [Face("bar", box(0, length, 0, depth), h)],
        {"wall": [((0, 0), (0, depth))], "sides": [((0, y), (length, y)) for y in (0, depth)]},
        quadrangles=dice.chance(0.5),
        regular=dice.chance(0.5),
    )
    there = length / speed_of_sound
    case = {
        "geometry": "plane_strain",
        "regions": {"bar": {"kind": dice.choice(["mpm", "fem"]), "material": "steel"}},
        "materials": {"steel": soil},
        "supports": {"wall": {"ux": 0}, "sides": {"uy": 0}},
        "initial_velocity": {"bar": {"velocity": {"x": -speed}}},
        "phases": [{"name": "impact", "analysis": "dynamic", "duration": typed(1.6 * there, 4), "step": {"initial": typed(0.4 * h / speed_of_sound, 4)}}],
        "output": {"history": [{"name": "wall", "on": "wall", "quantities": ["reaction_x"]}, {"name": "bar", "on": "bar", "quantities": ["vx"]}]},
    }
    force = soil["density"] * speed_of_sound * speed * depth
    momentum = soil["density"] * length * depth * speed

    def answers(result):
        time, reaction, velocity = (result.history[name] for name in ("time", "wall.reaction_x", "bar.vx"))
        plateau = (time > 0.2 * there) & (time < 1.5 * there)
        # The front spreads over about two cells and steps, which is what the force and the momentum may err by.
        slack = 2 * h / length
        return [
            near("mean force of the wall", reaction[plateau].mean(), force, slack / 2 * force),
            near("momentum after L/c", np.interp(there, time, velocity) * momentum / speed, 0, slack * momentum),
            # Of the equations, which conserve it but for what the time integration and the impact on the nodes of the wall take. The
            # sums of the log are those of the material points, which do not integrate the squares of a wave of a cell's length.
            below("gain of energy over that before", result.gain.max() / (momentum * speed / 2), 1e-6),
        ]

    return Scene(section, case, answers, case["regions"]["bar"]["kind"], dice.choice([1, 2, 2]), 2 * h / length)


def incline(dice):
    """A block on an incline: it slides by g(sin θ − tan δ cos θ)t²/2, or sticks."""
    angle = math.radians(dice.number(8, 35, 2))
    sticks = dice.chance(0.35)
    friction = typed(math.tan(angle) * (dice.uniform(1.1, 2) if sticks else dice.uniform(0, 0.85)), 2)
    width, height = dice.number(0.6, 1.5, 2), dice.number(0.2, 0.5, 2)
    h = typed(dice.uniform(0.25, 0.35), 2)
    acceleration = 0.0 if sticks else G * (math.sin(angle) - friction * math.cos(angle))
    duration = 0.5
    length = width + 2 + G * math.sin(angle) * duration**2 / 2
    floor = dice.choice(["wall", "soil", "soil wall"])
    faces = [Face("ground", box(0, length, -0.6, 0), h), Face("air", box(0, length, 0, height + 0.6), h)]
    body = Face("block", box(1, 1 + width, 0, height), 0.7 * h, structure=True)
    regions = {"ground": {"kind": "mpm", "material": "rock"}, "air": {"kind": "buffer"}, "block": {"kind": "structure", "material": "timber"}}
    contact = {"structure": "block", "soil": "ground", "friction": friction}
    if floor != "soil":
        # The contact nodes are on the block: the incline is a wall, and there is no ground.
        contact = {"wall": "slope", "against": "block", "friction": friction}
    if floor == "soil wall":
        faces = [
            Face("block", box(1, 1 + width, 0, height), h),
            Face("air", [(0, 0), (1, 0), (1, height), (1 + width, height), (1 + width, 0), (length, 0), (length, height + 0.6), (0, height + 0.6)], h),
        ]
        regions = {"air": {"kind": "buffer"}, "block": {"kind": "mpm", "material": "timber"}}
        contact = {"wall": "slope", "soil": "block", "friction": friction}
    else:
        faces.append(body)
    section = Section(faces, {"slope": [((0, 0), (length, 0))], "foot": [((0, -0.6), (length, -0.6)), ((0, -0.6), (0, 0)), ((length, -0.6), (length, 0))]})
    case = {
        "geometry": "plane_strain",
        "regions": regions,
        "materials": {
            "rock": {"model": "linear_elastic", "young": 1e5, "poisson": 0.2, "density": 2},
            "timber": {"model": "linear_elastic", "young": 1e5, "poisson": 0.2, "density": dice.number(0.6, 2.5, 2)},
        },
        "contacts": [contact],
        "supports": {"foot": {"ux": 0, "uy": 0}},
        "gravity": {"x": G * math.sin(angle), "y": -G * math.cos(angle)},
        "numerics": {"spectral_radius": 0.6},
        "phases": [{"name": "slide", "analysis": "dynamic", "duration": duration, "step": {"initial": 0.0125}}],
        "output": {"history": [{"name": "block", "on": "block", "quantities": ["ux", "uy"]}]},
    }
    if floor == "soil wall":
        case.pop("supports")
        section.curves.pop("foot")
        case["materials"].pop("rock")
    down = (1.0, 0.0)
    if dice.chance(0.5):
        c, s = math.cos(angle), math.sin(angle)
        section = section.moved(lambda x, y: (x * c + y * s, -x * s + y * c))
        case["gravity"] = {"y": -G}
        down = (c, -s)

    # Friction and the way err by 1 % of what gravity alone does (VERIFICATION of contact: sticking and sliding to 1 %).
    slack = 0.02 * G * math.sin(angle) * duration**2 / 2

    def answers(result):
        moved = np.array([result.last("block.ux"), result.last("block.uy")])
        along, across = moved @ down, moved @ (-down[1], down[0])
        return [near("way along the incline", along, acceleration * duration**2 / 2, slack), Check("way off the incline", across, -0.1 * h, 0.1 * h)]

    # A block that sticks swings by far less than the slack, and on another mesh otherwise.
    return Scene(section, case, answers, f"{floor}, {'sticks' if sticks else 'slides'}", least={"m": slack})
