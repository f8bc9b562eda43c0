"""Fair curves beside scipy's BFGS on random problems: called by peers.sh, or

    PYTHON benches/mvc.py --ours target/debug/examples/mvc --peer ../shared/peer-bench/bench_mvc.py [--count 200]

The objective is the peer's own (ScaffoldSketch Eq. 8-9, group mvc): both results are measured by it."""

import argparse, json, resource, subprocess, time

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
# Each problem is fitted sixteen times in either way.
own_cpu = 1e3 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime / (2 * 16)
their_cpu = 0.0

rows = []
for problem, mine in zip(problems, ours):
    f, x0 = make(problem["points"], problem["tangents"], problem["samples"])
    # The same objective without the corners of the 24 chords of a segment.
    exact, _ = make(problem["points"], problem["tangents"], problem["samples"], dense=600)
    started = time.process_time()
    free = minimize(f, x0, method="BFGS").x
    took = 1e3 * (time.process_time() - started)
    their_cpu += took
    # The set that Midair searches: a magnitude below zero runs a tangent against the stroke's own sense, with a cusp.
    own = np.exp(minimize(lambda y: f(np.exp(y)), np.log(x0), method="BFGS").x)
    chords, curve = (np.array(mine[way]["magnitudes"]) for way in ("chords", "curve"))
    over = lambda g, x, y: g(x) / max(g(y), 1e-300)
    rows.append(
        [over(f, chords, free), over(f, chords, own), over(exact, curve, free), over(exact, curve, own)]
        + [over(f, curve, free), mine["chords"]["ms"] / took, mine["curve"]["ms"] / took, (free > 0).all()]
    )
same, same_own, itself, itself_own, crossed, times, times_itself, whole = np.array(rows, float).T
share = lambda r: f"{100 * np.mean(r <= 1.02):.1f} %"
spread = lambda t: f"median {np.median(t):.5f}x, 90 % below {np.quantile(t, .9):.5f}x, worst {t.max():.5f}x"
print(f"fair curves, {args.count} random problems of 4 to 10 keypoints, beside scipy BFGS in one run; <= 1.02x its objective in")
print(f"  {share(same)} (at least 90), both on the peer's objective, along chords; median {np.median(same):.3f}x")
print(f"    {share(same[whole > 0])} of the {int(whole.sum())} in which scipy turns no tangent round (Midair never does)")
print(f"    {share(same_own)} where BFGS too keeps the stroke's own sense (it searches the logarithms)")
print(f"  {share(itself)} measured along the curve itself, where Midair fits; {share(itself_own)} in the stroke's own sense")
print(f"    {share(crossed)} if that curve is measured along chords all the same")
print(f"  processor time (at most 0.01 of scipy's): {own_cpu / their_cpu:.5f}x over all problems, {own_cpu:.0f} of {their_cpu:.0f} ms")
print(f"    by the clock, each problem against scipy's processor time: {spread(times)}")
print(f"    along the curve itself: {spread(times_itself)}")
