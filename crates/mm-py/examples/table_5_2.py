"""Table 5.2 of the thesis, its numbers beside ours, and the runs behind it as a figure.

    python table_5_2.py [FOLDER]
"""

# %% All experiments of the thesis; the table's rows are those of square-compare.
import sys
from pathlib import Path

import mmsim

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/table-5.2")
report = mmsim.reproduce(folder)
rows = [row for row in report["table"] if row["experiment"] == "square-compare"]
print(f"{'':20}{'':36}{'thesis':>10}{'ours':>10}")
for row in rows:
    thesis, ours = (f"{row[key]:10.4g}" if row[key] is not None else f"{'-':>10}" for key in ("thesis", "ours"))
    print(f"{row['controller']:20}{row['quantity']:36}{thesis}{ours}  {row['unit']}")

# %% The thesis's law against plain sliding mode, and the default that learns.
runs = mmsim.compare("square-compare", ["bsmc", "bfsmc-thesis", "bfsmc"])
print(runs)

# %% As a figure.
for kind, run in runs.runs.items():
    path = folder / f"square-compare-{kind}.png"
    run.plot().savefig(path, dpi=120)
    print(path)
