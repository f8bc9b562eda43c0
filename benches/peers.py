"""Midair's kernels beside their peers: called by peers.sh."""

import argparse, json, os, re, shlex, subprocess, sys, tempfile, time

NAMES = ["surface/sphere/256", "surface/sphere-dense/256", "surface/gyroid/256",
         "surface/dirty-64-in-256", "fuse/5x64-in-256", "bake/torus-25k", "brush/raw-torus"]


def flying_edges(threads):
    """VTK's FlyingEdges on the same grids; prints one JSON line {kind: [ms, ...]}."""
    import numpy as np
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk
    vtk.vtkSMPTools.SetBackend("STDThread")
    vtk.vtkSMPTools.Initialize(threads)
    a = np.linspace(0, 1, 256, dtype=np.float32)
    z, y, x = np.meshgrid(a, a, a, indexing="ij")
    k = np.float32(8 * np.pi)
    s, c = np.sin, np.cos
    grids = {
        "sphere": np.sqrt((x - .5) ** 2 + (y - .5) ** 2 + (z - .5) ** 2) - np.float32(.4),
        "gyroid": s(k * x) * c(k * y) + s(k * y) * c(k * z) + s(k * z) * c(k * x),
    }
    out = {}
    for kind, grid in grids.items():
        grid = np.ascontiguousarray(grid, dtype=np.float32)
        image = vtk.vtkImageData()
        image.SetDimensions(256, 256, 256)
        image.GetPointData().SetScalars(numpy_to_vtk(grid.reshape(-1), array_type=vtk.VTK_FLOAT))
        for normals in (0, 1):
            times = []
            started = time.perf_counter()
            while len(times) < 6 or time.perf_counter() - started < 1 and len(times) < 100:
                contour = vtk.vtkFlyingEdges3D()
                contour.SetInputData(image)
                contour.SetValue(0, 0.0)
                contour.SetComputeNormals(normals)
                contour.SetComputeGradients(0)
                contour.SetComputeScalars(0)
                begun = time.perf_counter()
                contour.Update()
                times.append(1e3 * (time.perf_counter() - begun))
            out[kind + " normals" * normals] = times[1:]
    print(json.dumps(out))


def blender():
    """Blender's voxel remesh of the torus of 25,600 triangles at 2/128; prints one JSON line [ms, ...]."""
    import bpy
    from math import cos, pi, sin
    around, across, large, small = 160, 80, 0.6, 0.25
    at = lambda i, j: (i % around) * across + j % across
    vertices, faces = [], []
    for i in range(around):
        a = 2 * pi * i / around
        for j in range(across):
            b = 2 * pi * j / across
            out = large + small * cos(b)
            vertices.append((out * cos(a), out * sin(a), small * sin(b)))
            faces += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    mesh = bpy.data.meshes.new("torus")
    mesh.from_pydata(vertices, [], faces)
    mesh.update()
    torus = bpy.data.objects.new("torus", mesh)
    bpy.context.scene.collection.objects.link(torus)
    remesh = torus.modifiers.new("remesh", "REMESH")
    remesh.mode = "VOXEL"
    times = []
    for i in range(8):
        remesh.voxel_size = 2 / 128 * (1 + 1e-6 * i)  # Else it would be remembered.
        begun = time.perf_counter()
        bpy.context.view_layer.update()
        made = torus.evaluated_get(bpy.context.evaluated_depsgraph_get())
        assert len(made.data.polygons) > 10_000
        times.append(1e3 * (time.perf_counter() - begun))
    print("\n" + json.dumps(times[1:]))


def main():
    parser = argparse.ArgumentParser()
    for name in ("ours", "loop", "parry", "prefix"):
        parser.add_argument("--" + name, default="")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--flying-edges", action="store_true")
    parser.add_argument("--blender", action="store_true")
    parser.add_argument("--blender-python", default=sys.executable)
    args = parser.parse_args()
    if args.blender:
        return blender()
    if args.flying_edges:
        return flying_edges(args.threads)

    env = dict(os.environ, RAYON_NUM_THREADS=str(args.threads))
    figures = {}  # name -> [(median, min), ...], one for each round

    def note(name, median, least):
        figures.setdefault(name, []).append((median, least))

    def call(*command):
        command = shlex.split(args.prefix) + list(command)
        done = subprocess.run(command, env=env, stdout=subprocess.PIPE, text=True)
        return done.stdout if done.returncode == 0 else ""

    def ours():
        with tempfile.NamedTemporaryFile(suffix=".json") as file:
            call(args.ours, *NAMES, "--json", file.name)
            for f in json.load(open(file.name)):
                note(f["name"], f["median"], f["min"])
                if "mesh_ms" in f["details"]:
                    welded = f["details"]["mesh_ms"]
                    note(f["name"] + " + one mesh", f["median"] + welded, f["min"] + welded)

    def vtk():
        text = call(sys.executable, __file__, "--flying-edges", "--threads", str(args.threads))
        for kind, times in (json.loads(text) if text else {}).items():
            times.sort()
            note("FlyingEdges " + kind, times[len(times) // 2], times[0])

    def remesh():
        pinned = ["taskset", "-c", ",".join(map(str, sorted(os.sched_getaffinity(0))[:args.threads]))]
        text = call(*pinned, args.blender_python, __file__, "--blender")
        times = sorted(json.loads(text.splitlines()[-1])) if text.strip() else []
        if times:
            note("Blender voxel remesh", times[len(times) // 2], times[0])

    def loop():
        if os.path.exists(args.loop):
            row = rf"fuse bbox-clip K=5 64\^3 -> 256\^3 {args.threads}thr ([\d.]+) ms"
            for best in re.findall(row, call(args.loop)):
                note("clipped loop in C", float(best), float(best))

    def parry():
        if os.path.exists(args.parry):
            row = rf"{args.threads}thr +torus25.6k 128\^3 +best +([\d.]+) ms med +([\d.]+) ms"
            for best, median in re.findall(row, call(args.parry, "parry")):
                note("parry3d", float(median), float(best))

    for i in range(args.rounds):
        ours(), vtk(), loop(), remesh()
        if i == 0:
            parry()  # Takes as long as all the others together.

    rows = [  # ours, theirs, the most their time may be multiplied by
        ("surface/sphere/256", "FlyingEdges sphere", 0.6),
        ("surface/sphere/256 + one mesh", "FlyingEdges sphere", None),
        ("surface/sphere-dense/256", "FlyingEdges sphere", None),
        ("surface/sphere-dense/256 + one mesh", "FlyingEdges sphere normals", None),
        ("surface/gyroid/256", "FlyingEdges gyroid", 1.0),
        ("surface/gyroid/256 + one mesh", "FlyingEdges gyroid", None),
        ("surface/gyroid/256 + one mesh", "FlyingEdges gyroid normals", None),
        ("surface/dirty-64-in-256", "FlyingEdges sphere", 0.02),
        ("fuse/5x64-in-256", "clipped loop in C", 0.15),
        ("bake/torus-25k/128", "parry3d", 0.06),
        ("bake/torus-25k-cube/128", "parry3d", None),
        ("brush/raw-torus/128", "Blender voxel remesh", 0.1),
    ]
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    print(f"{args.threads} threads, best of {args.rounds} rounds, load {load:.1f}; ms")
    head = ("ours", "median", "min", "theirs", "median", "min", "ratio", "of mins", "at most")
    line = "{:36} {:>9} {:>9}  {:27} {:>9} {:>9} {:>8} {:>8} {:>8}"
    print(line.format(*head))
    for mine, theirs, most in rows:
        if mine in figures and theirs in figures:
            (a, b), (c, d) = (
                [min(column) for column in zip(*figures[n])] for n in (mine, theirs))
            limit = "" if most is None else f"{most}x"
            print(line.format(mine, f"{a:.2f}", f"{b:.2f}", theirs, f"{c:.2f}", f"{d:.2f}",
                              f"{a / c:.3f}x", f"{b / d:.3f}x", limit))
    missing = {theirs for _, theirs, _ in rows} - set(figures)
    if missing:
        print("left out: " + ", ".join(sorted(missing)))


main()
