# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # A walking leg, from a sketch to a file for the cutter
#
# This notebook draws a foot's path, finds four-bar linkages that trace it, looks at what they cost in size and in force,
# and ends with a drawing to cut from. It needs `pip install "linkwright[plot,frame]"`.
#
# The foot of a walking machine should move straight along the ground for half of its cycle, and come back above it.

# %%
import math
import os
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import linkwright as lw
import linkwright.sweep

# A stride of 100 mm on the ground, and a lift of 30 mm.
stance = [(50 - 100 * t, 0.0) for t in np.linspace(0, 1, 10)]
swing = [(-50 * math.cos(u), 30 * math.sin(u)) for u in np.linspace(0, math.pi, 14)[1:-1]]
foot = np.array(stance + swing)

plt.plot(*foot.T, "o-")
plt.gca().set_aspect("equal")
plt.title("the foot's path, mm")

# %% [markdown]
# The problem: a closed path, and what the leg must be able to do. A motor drives it, so that the crank has to turn fully;
# the transmission angle keeps away from toggles; and it must fit into the machine. All keys are those of a problem file,
# and what is refused is refused with the place and the remedy.

# %%
problem = lw.path(
    foot,
    closed=True,
    require={"type": ["crank-rocker"], "transmission_deg_min": 30, "extent_max": 400},
    name="walking-leg",
    unit="mm",
)
try:
    lw.path(foot, require={"transmission_deg_mim": 30})
except lw.ProblemError as refused:
    print(refused)

# %%
leg = lw.synth(problem, seed=1)
leg

# %% [markdown]
# `leg` shows the drawing and the table of the report. Every figure is recomputed by code that did not take part in the
# search; `lw.verify` does that again, and the same seed gives the same bytes on any number of threads.

# %%
best = leg.candidates[0]
assert best.accepted
assert lw.verify(leg)
assert lw.synth(problem, seed=1, threads=1).record_json == leg.record_json
print(f"{best.type}, worst error {best.error['max']:.2f} mm, transmission angle {best.transmission_deg['worst']:.0f} degrees")

# %% [markdown]
# The linkage itself can be moved: positions, velocities and accelerations are arrays. Here is the speed of the foot over
# a turn of the motor at 60 turns a minute.

# %%
phi = np.linspace(0, 2 * np.pi, 721)
speed = best.linkage.velocities(phi, omega=2 * np.pi)
plt.plot(np.degrees(phi), np.hypot(*speed.P.T))
plt.xlabel("crank angle, degrees")
plt.ylabel("speed of the foot, mm/s")

# %%
best.plot()

# %% [markdown]
# `best.animate()` plays it. Before it is cut: how thick does it become, and which dimension matters most?

# %%
to_build = lw.build(best, hole=4)
print(to_build.text)

# %% [markdown]
# The plates as a DXF file for a laser cutter, with holes of 4 mm:

# %%
folder = tempfile.mkdtemp()
dxf = os.path.join(folder, "walking-leg.dxf")
best.to_file(dxf, "dxf-plates", hole_mm=4, kerf_mm=0.15)
print(os.path.getsize(dxf), "bytes")

# %% [markdown]
# # The trade-off
#
# A smaller leg follows the path less closely. The front holds linkages none of which is beaten in error, transmission angle
# and extent together.

# %%
tradeoff = lw.front(problem, axes=("rms", "extent"), points=10)
tradeoff.front.plot()

# %%
tradeoff.front.to_frame().iloc[:, :8].round(2)

# %% [markdown]
# # A sweep
#
# How does the error depend on the transmission angle and on the size that are allowed? A sweep runs a problem for all
# combinations of values: on the cores of this machine here, and with `linkwright.dask` on many machines. Its folder is
# resumable, and the table has the same bytes however it was run.

# %%
with open(os.path.join(folder, "leg.toml"), "w") as file:
    file.write(problem.text)
with open(os.path.join(folder, "leg-sweep.toml"), "w") as file:
    file.write(
        """
format = 1
problem = "leg.toml"
[vary]
require.extent_max = { from = 200, to = 400, steps = 5 }
require.transmission_deg_min = { from = 20, to = 50, steps = 4 }
solve.advice = [false]
solve.evaluations = [50000]
"""
    )
plan = lw.sweep.plan(os.path.join(folder, "leg-sweep.toml"), os.path.join(folder, "sweep"), shard_size=4)
lw.sweep.run(plan.folder)
table = lw.sweep.merge(plan.folder).to_frame()
table.head()

# %%
accepted = table[table["status"] == "accepted"]
grid = accepted.pivot(index="require.extent_max", columns="require.transmission_deg_min", values="rms")
shown = plt.contourf(grid.columns, grid.index, grid.values, levels=12)
plt.colorbar(shown, label="rms error, mm")
plt.xlabel("least transmission angle, degrees")
plt.ylabel("greatest extent, mm")

# %% [markdown]
# Where nothing is drawn no acceptable linkage was found. The same sweep on a cluster:
#
# ```python
# import linkwright.dask
# linkwright.dask.sweep(plan.folder, client)
# ```
