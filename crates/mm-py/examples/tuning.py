"""Gains that cost less than the defaults, tried on a plant that the search did not know.

    python tuning.py [PARTICLES ITERATIONS]
"""

# %%
import sys

import mmsim

particles, iterations = (int(word) for word in sys.argv[1:3]) if len(sys.argv) > 2 else (12, 15)
search = {"simulation.duration_s": 20.0, "tune.particles": particles, "tune.iterations": iterations}
tuned = mmsim.tune("square-compare", "bfsmc", overrides=search)
print(tuned)

# %% On 32 random robots, disturbances and starts: does it still pay?
for label, gains in (("defaults", {}), ("tuned", tuned.gains)):
    overrides = {"simulation.duration_s": 20.0, "controller.gains": gains}
    result = mmsim.sweep("square-compare", 32, controller="bfsmc", overrides=overrides)
    median = {row["name"]: row["median"] for row in result.report["statistics"]}
    print(f"{label:9} failures {result.report['failures']}  median RMS {1e3 * median['rmse_m']:.4g} mm"
          f"  median torque variation {median['torque_tv_n_m_per_s']:.4g} N m/s")
