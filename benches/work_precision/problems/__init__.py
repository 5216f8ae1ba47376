"""The problems of the work–precision runs, a module each."""

from dataclasses import dataclass, field


@dataclass
class Variant:
    """A run: where it stands on the axis of its series, and the entries of the case that it changes."""

    at: float
    settings: dict
    peer: dict = field(default_factory=dict)  # arguments of the peer's scene; without them it does not run


@dataclass
class Series:
    """Runs of every scheme along one axis."""

    name: str
    axis: str
    variants: list
    schemes: list | None = None  # names; without it all
    quick: tuple = (0, 1, 2)  # places of the variants that a quick run keeps


@dataclass
class Problem:
    """What is solved, the measures of its errors and the series of runs."""

    name: str
    title: str
    text: str
    scene: object  # a case as a dictionary, or its folder
    measures: dict  # key: what it is, with its unit
    series: list
    errors: object  # function of (Run, entries of the case): {key: error}
    points_paths: list  # entries of the case with the points a cell
    peer: str | None = None  # scene of benches/peers/kratos_elastic.py
    peer_errors: object = None  # function of the peer's arrays: {key: error}
    others: dict = field(default_factory=dict)  # programs not run here: name: {place on the axis of the first series: (first error, seconds)}
    prepare: object = None  # called before the first run, makes the reference; returns what it says of itself
