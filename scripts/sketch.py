#!/usr/bin/env python3
"""Writes the sessions that draw with Scaffold: python3 scripts/sketch.py assets/sessions

Every end is off by up to a centimetre and strokes wobble, as a hand is and does; what comes out is exact all the
same. The hands never move faster than 1 m/s."""

import math, random, sys

NOISE = 0.008


class Sketch:
    def __init__(self, title, about, seed):
        self.title, self.about, self.random = title, about, random.Random(seed)
        self.steps = ['Ask(Mode("scaffold")),']
        self.at = (0.2, 1.1, 0.3)
        self.count = 0

    def off(self, p, by=NOISE):
        while True:
            d = [self.random.uniform(-1, 1) for _ in range(3)]
            if sum(x * x for x in d) <= 1:
                return tuple(round(a + by * b, 4) for a, b in zip(p, d))

    def say(self, text):
        self.steps += ["", "// " + text]

    def move(self, to, speed=0.5, least=0.1):
        far = math.dist(self.at, to)
        over = max(least, round(far / speed, 3))
        self.steps.append(f"Move(hand: Right, to: ({to[0]}, {to[1]}, {to[2]}), over: {over}),")
        self.at = to

    def line(self, a, b):
        self.move(self.off(a))
        self.steps.append("Press(Right, Act),")
        self.move(self.off(b))
        self.steps.append("Release(Right, Act),")
        self.count += 1

    def tick(self, p, across):
        """A very short line across a line."""
        half = 0.008
        self.move(tuple(round(a - half * b, 4) for a, b in zip(p, across)))
        self.steps.append("Press(Right, Act),")
        self.move(tuple(round(a + half * b, 4) for a, b in zip(p, across)), least=0.15)
        self.steps.append("Release(Right, Act),")

    def strokes(self, draws):
        if draws:
            self.steps += ['Ask(Set(key: "scaffold.draws", value: "\\"Stroke\\"")),']
        else:
            self.steps += ['Ask(Set(key: "scaffold.draws", value: "\\"Line\\"")),']

    def stroke(self, points, wobble=0.006):
        """A free curve through points, in pieces of about a centimetre and a half."""
        long = sum(math.dist(a, b) for a, b in zip(points, points[1:]))
        count = max(6, round(long / 0.03))
        phase = [self.random.uniform(0, 6.3) for _ in range(3)]
        out = []
        for i in range(count + 1):
            s, k = long * i / count, 0
            while k + 2 < len(points) and s > math.dist(points[k], points[k + 1]):
                s -= math.dist(points[k], points[k + 1])
                k += 1
            a, b = points[k], points[k + 1]
            t = s / max(math.dist(a, b), 1e-9)
            u = 9.0 * i / count
            out.append(tuple(round(x + (y - x) * t + wobble * math.sin(u + f), 4) for x, y, f in zip(a, b, phase)))
        self.move(out[0])
        self.steps.append("Press(Right, Act),")
        for p in out[1:]:
            self.move(p, speed=0.45, least=0.02)
        self.steps.append("Release(Right, Act),")
        self.count += 1

    def arc(self, middle, u, v, start, end, more=48):
        at = lambda t: tuple(m + math.cos(t) * a + math.sin(t) * b for m, a, b in zip(middle, u, v))
        return [at(start + (end - start) * i / more) for i in range(more + 1)]

    def write(self, folder, name):
        lines = [f"// {line}" for line in self.about] + ["(", "    format: 1,", f'    title: "{self.title}",', "    steps: ["]
        lines += ["        " + s if s else "" for s in self.steps]
        lines += ["    ],", ")"]
        with open(f"{folder}/{name}.ron", "w") as file:
            file.write("\n".join(lines) + "\n")


def box(s, low, high):
    """Twelve edges, as one draws them: the ground, the posts, the top."""
    x, y, z = zip(low, high)
    c = [(x[i & 1], y[i >> 2 & 1], z[i >> 1 & 1]) for i in range(8)]
    for a, b in [(0, 1), (1, 3), (3, 2), (2, 0), (0, 4), (1, 5), (3, 7), (2, 6), (4, 5), (5, 7), (7, 6), (6, 4)]:
        s.line(c[a], c[b])
    return c


def rounded(x0, x1, y0, y1, z, r):
    """A rectangle with round corners in the plane z, from the middle of its lower edge round."""
    quarter = lambda cx, cy, a: [(cx + r * math.cos(a + i * math.pi / 16), cy + r * math.sin(a + i * math.pi / 16), z) for i in range(9)]
    p = [((x0 + x1) / 2, y0, z)]
    p += quarter(x1 - r, y0 + r, -math.pi / 2) + quarter(x1 - r, y1 - r, 0)
    p += quarter(x0 + r, y1 - r, math.pi / 2) + quarter(x0 + r, y0 + r, math.pi)
    return p + [p[0]]


def tutorial(folder):
    s = Sketch("The study's tutorial object", [
        "The tutorial object of ScaffoldSketch's study (§5.1, Fig. 8): a cylinder with rounded rectangular faces.",
        "midair play assets/sessions/tutorial-object.ron --hands-only --export object.glb --report object.json",
    ], 4)
    low, high, r = (-0.22, 0.8, -0.15), (0.22, 1.1, 0.15), 0.08
    s.say("A box of construction lines, every end off by up to 8 mm.")
    box(s, low, high)
    s.say("Tick marks where the corners begin to be round, on both faces.")
    for z in (high[2], low[2]):
        for y in (low[1], high[1]):
            for x in (low[0] + r, high[0] - r):
                s.tick((x, y, z), (0, 1, 0))
        for x in (low[0], high[0]):
            for y in (low[1] + r, high[1] - r):
                s.tick((x, y, z), (1, 0, 0))
    s.say("The two faces, each in one stroke, and the edges between them.")
    s.strokes(True)
    for z in (high[2], low[2]):
        s.stroke(rounded(low[0], high[0], low[1], high[1], z, r), wobble=0.004)
    for x, y in [(low[0] + r, low[1]), (high[0] - r, low[1]), (low[0] + r, high[1]), (high[0] - r, high[1])]:
        s.stroke([(x, y, high[2]), (x, y, low[2])], wobble=0.003)
    s.steps += ["", "Move(hand: Right, to: (0.5, 1.2, 0.5)),", "Wait(0.3),", f"Expect(objects: {s.count}, warnings: 0),"]
    s.write(folder, "tutorial-object")


def can(folder):
    s = Sketch("A trash can", [
        "The directed task of ScaffoldSketch's study (Fig. 9): a trash can, wider at its top.",
        "midair play assets/sessions/trash-can.ron --hands-only --export trash-can.glb --report trash-can.json",
    ], 9)
    y0, y1, a, b = 0.7, 1.15, 0.13, 0.19
    s.say("A square on the ground, one in the air above it, and what joins their corners.")
    ring = lambda y, h: [(-h, y, -h), (h, y, -h), (h, y, h), (-h, y, h)]
    low, high = ring(y0, a), ring(y1, b)
    for c in (low, high):
        for i in range(4):
            s.line(c[i], c[(i + 1) % 4])
    for i in range(4):
        s.line(low[i], high[i])
    s.say("Round the foot, round the rim, and down the four sides.")
    s.strokes(True)
    around = lambda y, h: s.arc((0, y, 0), (h, 0, 0), (0, 0, h), math.pi / 2, 2.5 * math.pi)
    s.stroke(around(y0, a), wobble=0.004)
    s.stroke(around(y1, b), wobble=0.004)
    for u in [(1, 0), (0, 1), (-1, 0), (0, -1)]:
        s.stroke([(b * u[0], y1, b * u[1]), (a * u[0], y0, a * u[1])], wobble=0.003)
    s.steps += ["", "Move(hand: Right, to: (0.5, 1.4, 0.5)),", "Wait(0.3),", f"Expect(objects: {s.count}, warnings: 0),"]
    s.write(folder, "trash-can")


def mug(folder):
    s = Sketch("A mug", [
        "A mug with a handle, drawn with Scaffold (ScaffoldSketch Fig. 6).",
        "midair play assets/sessions/mug.ron --hands-only --export mug.glb --report mug.json",
    ], 21)
    low, high = (-0.16, 0.8, -0.16), (0.16, 1.2, 0.16)
    s.say("The box that the mug just fits into.")
    box(s, low, high)
    s.say("For the handle: up the middle of the right face, and out from it.")
    mid = 0.0
    s.line((0.16, 0.8, mid), (0.16, 1.2, mid))
    s.line((0.16, 1.1, mid), (0.3, 1.1, mid))
    s.line((0.16, 0.9, mid), (0.3, 0.9, mid))
    s.line((0.3, 0.9, mid), (0.3, 1.1, mid))
    s.say("Foot, rim, sides and handle.")
    s.strokes(True)
    around = lambda y: s.arc((0, y, 0), (0.16, 0, 0), (0, 0, 0.16), math.pi / 2, 2.5 * math.pi)
    s.stroke(around(0.8), wobble=0.004)
    s.stroke(around(1.2), wobble=0.004)
    for u in [(1, 0), (0, 1), (-1, 0), (0, -1)]:
        s.stroke([(0.16 * u[0], 1.2, 0.16 * u[1]), (0.16 * u[0], 0.8, 0.16 * u[1])], wobble=0.003)
    s.stroke([(0.16, 1.1, 0)] + s.arc((0.2, 1.0, 0), (0, 0.1, 0), (0.1, 0, 0), 0, math.pi)[4:-4] + [(0.16, 0.9, 0)], wobble=0.003)
    s.steps += ["", "Move(hand: Right, to: (0.5, 1.4, 0.5)),", "Wait(0.3),", f"Expect(objects: {s.count}, warnings: 0),"]
    s.write(folder, "mug")


def figure5(folder):
    s = Sketch("Four strokes in a square", [
        "Fig. 5 of ScaffoldSketch: a circle, a rounded square, an S and a spiral, each over a square scaffold.",
        "midair play assets/sessions/figure-5.ron --hands-only --report figure-5.json",
    ], 5)
    h = 0.2
    places = [(-0.75, 1.0, 0.0), (-0.25, 1.0, 0.0), (0.25, 1.0, 0.0), (0.75, 1.0, 0.0)]
    s.say("Four squares.")
    for x, y, z in places:
        c = [(x - h, y - h, z), (x + h, y - h, z), (x + h, y + h, z), (x - h, y + h, z)]
        for i in range(4):
            s.line(c[i], c[(i + 1) % 4])
    s.say("Where the corners of the second begin to be round.")
    x, y, z = places[1]
    for e in (-h, h):
        for o in (-0.11, 0.11):
            s.tick((x + o, y + e, z), (0, 1, 0))
            s.tick((x + e, y + o, z), (1, 0, 0))
    s.strokes(True)
    x, y, z = places[0]
    s.say("A circle through the middles.")
    s.stroke(s.arc((x, y, z), (h, 0, 0), (0, h, 0), 0, 2 * math.pi), wobble=0.008)
    x, y, z = places[1]
    s.say("A rounded square through the tick marks.")
    s.stroke(rounded(x - h, x + h, y - h, y + h, z, 0.09), wobble=0.006)
    x, y, z = places[2]
    s.say("An S, along the middles of the upper and the lower side.")
    up = s.arc((x, y + 0.1, z), (0.1, 0, 0), (0, 0.1, 0), 0.2, math.pi * 1.5)
    down = s.arc((x, y - 0.1, z), (0.1, 0, 0), (0, 0.1, 0), math.pi / 2, -math.pi + 0.2)
    s.stroke(up + down[1:], wobble=0.005)
    x, y, z = places[3]
    s.say("A spiral in from a corner.")
    spiral = [(x + (0.24 - 0.2 * i / 90) * math.cos(math.pi / 4 + i * 0.075), y + (0.24 - 0.2 * i / 90) * math.sin(math.pi / 4 + i * 0.075), z) for i in range(91)]
    s.stroke(spiral, wobble=0.005)
    s.steps += ["", "Move(hand: Right, to: (0.5, 1.4, 0.5)),", "Wait(0.3),", f"Expect(objects: {s.count}, warnings: 0),"]
    s.write(folder, "figure-5")


for draw in (tutorial, can, mug, figure5):
    draw(sys.argv[1])
