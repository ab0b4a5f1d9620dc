"""Examples of the tests' own, sent inline, so that no test depends on what is built in."""

import os
import random

# Infallible and quick: every block is accepted.
YARD = {
    "kind": "discrete", "name": "yard", "cell": [2, 1.5, 3],
    "pieces": [{"name": "air"}, {"name": "ground"}, {"name": "post"},
               {"name": "gate", "turns": 1}, {"name": "arch", "turns": 2},
               {"name": "door", "turns": 3}],
    "size": [6, 3, 5],
    "cells": [1] * 30 +
             [0, 0, 0, 0, 0, 0, 0, 2, 3, 4, 5, 0, 0, 5, 2, 3, 4, 0, 0, 0, 2, 0, 5, 0,
              0, 0, 0, 0, 0, 0] +
             [0] * 30,
    "empty": "air",
}


def _wang_tiles(count, colors, seed):
    """A floor of tiles whose edges must have one colour: blocks of it often fail. The first tile
    repeats, so that there is a model to start with."""
    rng = random.Random(seed)
    tiles = [(0, 0, 0, 0)]
    while len(tiles) < count:
        tile = tuple(rng.randrange(colors) for _ in range(4))
        if tile not in tiles:
            tiles.append(tile)
    names = [f"tile{index}" for index in range(count)]
    east, south, west, north = range(4)
    return {
        "kind": "discrete", "name": "tiles", "pieces": [{"name": name} for name in names],
        "adjacency": {
            "x": [[a, b] for a, s in zip(names, tiles) for b, t in zip(names, tiles)
                  if s[east] == t[west]],
            "z": [[a, b] for a, s in zip(names, tiles) for b, t in zip(names, tiles)
                  if s[south] == t[north]],
        },
    }


# Most of its blocks need more than one attempt.
TILES = _wang_tiles(20, 4, 5)
TILES_JOB = {"example": TILES, "size": (60, 1, 60), "parameters": {
    "weights": "uniform", "blocks": {"size": [8, 1, 8], "overlap": 0, "attempts": 1}}}

# Many of its blocks are reverted, since they would have more cells of one tile.
DECLINED_JOB = {**TILES_JOB, "parameters": {**TILES_JOB["parameters"], "constraints": [
    {"kind": "objective", "terms": [
        {"term": "count", "pieces": [TILES["pieces"][0]["name"]], "target": 0}]}]}}

# A job in the middle of which there is time to do something: thousands of blocks, a second or more.
# Half of it is a passage of a few hundred milliseconds. A sanitizer needs fewer and smaller blocks.
_SANITIZED = bool(os.environ.get("MODELSYNTH_SANITIZED"))
STEADY_PASSES = 9 if _SANITIZED else 60
STEADY_JOB = {"example": YARD, "size": (100, 6, 100), "parameters": {
    "weights": "uniform",
    "blocks": {**({} if _SANITIZED else {"size": [20, 6, 20], "overlap": 0.75}),
               "passes": STEADY_PASSES}}}

# Thousands of blocks as well, but no cell is made twice in different passes: what is lost of it
# stays lost.
SWEEP_JOB = {"example": YARD, "size": (240, 6, 240), "parameters": {"weights": "uniform"}}

# Dozens of blocks, done at once.
SMALL_JOB = {"example": YARD, "size": (30, 6, 30), "parameters": {"weights": "uniform"}}

# So long that it ends by being cancelled or killed only.
ENDLESS_JOB = {"example": YARD, "size": (300, 6, 300), "parameters": {
    "weights": "uniform", "blocks": {"size": [40, 6, 40], "overlap": 0.875, "passes": 70}}}


def submit(server, job, **more):
    """Submits a job of this file."""
    return server.submit(**{**job, **more, "parameters": dict(job["parameters"])})
