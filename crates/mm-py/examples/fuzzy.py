"""A fuzzy system from a file: evaluated, compiled for a microcontroller, and used by the controller.

    python fuzzy.py [FILE.fis]
"""

# %%
import sys
import tempfile
from pathlib import Path

import numpy as np

import mmsim

fis = mmsim.Fis.from_file(sys.argv[1]) if len(sys.argv) > 1 else mmsim.Fis.smooth()
x = np.linspace(-1, 1, 9)
print(fis, dict(zip(x.tolist(), fis.evaluate(x).round(4).tolist())))

# %% Whole numbers for a processor without floating point, and what they cost.
table = fis.compile(bits=16)
print(table, "differs by at most", np.abs(table.evaluate(x) - fis.evaluate(x)).max())
print(table.to_c("smooth").splitlines()[0])

# %% In the loop.
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "own.fis"
    file.write_text(fis.to_fis())
    run = mmsim.simulate("square", overrides={"simulation.duration_s": 5.0, "controller.fis": str(file)})
    print(run)
