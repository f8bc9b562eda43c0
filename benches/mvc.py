"""Fair curves beside scipy's BFGS on random problems: called by peers.sh, or

    PYTHON benches/mvc.py --ours target/debug/examples/mvc --peer ../shared/peer-bench/bench_mvc.py [--count 200]

The objective is the peer's own (ScaffoldSketch Eq. 8-9, group mvc): both results are measured by it."""

import argparse, json, subprocess, time

import numpy as np
from scipy.optimize import minimize

parser = argparse.ArgumentParser()
parser.add_argument("--ours", required=True)
parser.add_argument("--peer", required=True)
parser.add_argument("--count", type=int, default=200)
args = parser.parse_args()
space = {}
exec(open(args.peer).read().split('print("scipy"')[0], space)
make, cplx = space["make"], space["cplx"]

problems = []
for i in range(args.count):
    k = 4 + i % 7
    Q, D = cplx(k, seed=1000 + i)
    D = D / np.linalg.norm(D, axis=1)[:, None]
    problems.append({"points": Q.tolist(), "tangents": D.tolist(), "samples": 10 * k})
done = subprocess.run([args.ours], input=json.dumps(problems), stdout=subprocess.PIPE, text=True, check=True)
ours = json.loads(done.stdout)

ratios, fine, times, whole = [], [], [], []
for problem, mine in zip(problems, ours):
    f, x0 = make(problem["points"], problem["tangents"], problem["samples"])
    # The same objective without the corners of the 24 chords of a segment.
    exact, _ = make(problem["points"], problem["tangents"], problem["samples"], dense=600)
    started = time.perf_counter()
    theirs = minimize(f, x0, method="BFGS")
    took = 1e3 * (time.perf_counter() - started)
    x = np.array(mine["magnitudes"])
    ratios.append(f(x) / max(theirs.fun, 1e-300))
    fine.append(exact(x) / max(exact(theirs.x), 1e-300))
    times.append(mine["ms"] / took)
    # A magnitude below zero runs a tangent backwards: the curve has a cusp there, which no stroke has.
    whole.append(bool((theirs.x > 0).all()))
ratios, fine, times, whole = map(np.array, (ratios, fine, times, whole))
share = lambda r: 100 * np.mean(r <= 1.02)
print(f"fair curves, {args.count} random problems of 4 to 10 keypoints, beside scipy BFGS in one run")
print(f"  objective <= 1.02x: {share(ratios):.1f} % (at least 90); measured on the curve itself {share(fine):.1f} %")
print(f"  of the {whole.sum()} in which scipy turns no tangent round: {share(ratios[whole]):.1f} %, on the curve itself {share(fine[whole]):.1f} %")
print(f"  objective: median {np.median(ratios):.3f}x, 90 % below {np.quantile(ratios, .9):.3f}x")
print(f"  time: median {np.median(times):.5f}x, 90 % below {np.quantile(times, .9):.5f}x (at most 0.01)")
