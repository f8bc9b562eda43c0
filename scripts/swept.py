#!/usr/bin/env python3
"""Writes the sessions of Sweep's figures into assets/sessions: what two hands do, step by step.

    scripts/swept.py

figure-1: an open surface, a tube and cloned meshes. figure-10: closed curves, each swept a little, two of them crossing
themselves. figure-11: one curve with clones, its points spread in three ways.
figure-13: a shell, a horn, a knot and a spiral of clones, as in Figures 1 and 13 of the Hermite motion controller.
"""
from math import cos, pi, sin
from pathlib import Path

OUT = Path(__file__).resolve().parent.parent / "assets" / "sessions"


def num(x):
    return f"{round(x, 4) + 0.0:g}"


def hand(at, turn):
    return f"(to: ({', '.join(map(num, at))}), turn: ({', '.join(map(num, turn))}))"


class Session:
    def __init__(self, name, title, about):
        self.name, self.title, self.about = name, title, about
        self.steps, self.made = [], 0

    def say(self, line):
        self.steps.append(line)

    def note(self, line):
        self.steps.append(f"// {line}")

    def set(self, key, value):
        self.say(f'Ask(Set(key: "sweep.{key}", value: "{value}")),')

    def shape(self, shape):
        self.set("shape", f'\\"{shape}\\"')

    def slopes(self, w0, w1):
        self.say(f'Ask(Tool(tool: "sweep", ask: "Slopes({num(w0)}, {num(w1)})")),')

    def go(self, left, right, over):
        self.say(f"Both(left: {hand(*left)}, right: {hand(*right)}, over: {num(over)}),")

    def look(self, colour, material=None):
        self.say(f"Ask(Objects(Colour(colour: ({colour[0]}, {colour[1]}, {colour[2]})))),")
        if material:
            self.say(f'Ask(Objects(Material(material: "{material}"))),')

    def sweep(self, ways, over, colour=None, material=None):
        """The hands go to the first place, and along the rest with the trigger held."""
        self.go(*ways[0], 0.9)
        self.say("Wait(0.5),")
        self.say("Press(Right, Act),")
        for left, right in ways[1:]:
            self.go(left, right, over)
        self.say("Release(Right, Act),")
        self.say("Wait(0.2),")
        self.made += 1
        if colour:
            self.look(colour, material)

    def write(self):
        body = "\n".join(f"        {s}" if s else "" for s in self.steps)
        text = f"""// {self.about}
// Written by scripts/swept.py; performed by two hands from an empty document:
// midair play assets/sessions/{self.name}.ron --hands-only --shot {self.name}.png
(
    format: 1,
    title: "{self.title}",
    hands: (left: (-0.2, 1.0, 0.3), right: (0.2, 1.0, 0.3)),
    steps: [
        Ask(Mode("sweep")),
{body}
        Ask(Objects(SelectNone)),
        // The hands go out of the picture.
        Both(left: (to: (-0.2, 1.0, 3.0)), right: (to: (0.2, 1.0, 3.0)), over: 3),
        Expect(objects: {self.made}, warnings: 0),
    ],
)
"""
        (OUT / f"{self.name}.ron").write_text(text)


def figure_1():
    s = Session("figure-1", "An open surface, a tube and cloned meshes", "Models as in Fig. 1: an open surface, a tube that rolls itself up, and cones that stand over a dome.")
    s.set("smooth", "8")
    s.set("count", "96")
    s.note("A ruffle: its inner edge rises in a spiral, its outer one waves around it.")
    s.shape("Surface")
    ways = []
    for i in range(73):
        t = i / 72
        a = 2 * pi * 1.6 * t
        r = 0.2 + 0.04 * sin(5 * a)
        inner = (-0.62 + 0.035 * cos(a), 0.92 + 0.34 * t, 0.035 * sin(a))
        outer = (-0.62 + r * cos(a), 0.86 + 0.34 * t + 0.05 * cos(5 * a), r * sin(a))
        ways.append(((inner, (0, -a * 180 / pi, 40)), (outer, (0, -a * 180 / pi, -35))))
    s.sweep(ways, 0.13, (232, 152, 118))
    s.note("A snail: the tube widens as it goes round and up.")
    s.shape("Tube")
    ways = []
    for i in range(64):
        t = i / 63
        a = 2 * pi * 2.2 * t
        r = 0.05 + 0.16 * t
        half = 0.012 + 0.075 * t
        out = (cos(a), 0, sin(a))
        middle = (0.02 + r * out[0], 1.22 - 0.26 * t, r * out[2])
        left = [m - half * o for m, o in zip(middle, out)]
        right = [m + half * o for m, o in zip(middle, out)]
        yaw = -a * 180 / pi
        ways.append(((left, (0, yaw, 70)), (right, (0, yaw, -70))))
    s.sweep(ways, 0.16, (108, 150, 206))
    s.note("Cones over a dome: they stand closer, and are smaller, towards its middle.")
    s.shape("Clones")
    s.set("item", '{\\"Component\\": \\"solid/cone\\"}')
    s.set("spread", "true")
    s.set("clones", "10")
    s.set("clone_size", "0.062")
    s.slopes(0.35, 1.3)
    ways = []
    for i in range(49):
        t = i / 48
        a = 2 * pi * t * 0.985
        top = (0.66 + 0.02 * cos(a), 1.2, 0.02 * sin(a))
        rim = (0.66 + 0.22 * cos(a), 0.96, 0.22 * sin(a))
        yaw = -a * 180 / pi
        ways.append(((top, (0, yaw, 0)), (rim, (0, yaw, -75))))
    s.sweep(ways, 0.13, (150, 186, 112))
    s.write()


def figure_10():
    s = Session("figure-10", "Closed curves", "Closed curves as in Fig. 10, two of which cross themselves: each is swept a little and closed by its caps.")
    s.note("What crosses itself is drawn from its field: finely.")
    s.say("Ask(Step(0.002)),")
    s.shape("Tube")
    s.set("count", "96")
    # Where it stands, how the hands are rolled.
    for x, y, left, right in [
        (-0.5, 1.3, (0, 0, 60), (0, 0, -60)),
        (-0.17, 1.3, (0, 0, 90), (0, 0, -20)),
        (0.17, 1.3, (0, 0, 120), (0, 0, -120)),
        (0.5, 1.3, (0, 0, 75), (0, 0, 75)),
        (-0.5, 1.0, (0, 0, 35), (0, 0, -100)),
        (-0.17, 1.0, (0, 0, 150), (0, 0, -60)),
        (0.17, 1.0, (0, 0, -70), (0, 0, 130)),
        (0.5, 1.0, (0, 0, 100), (0, 0, 50)),
    ]:
        ways = [(((x - 0.1, y, z), left), ((x + 0.1, y, z), right)) for z in (0.03, -0.03)]
        s.sweep(ways, 0.4, (222, 190, 130))
    s.write()


def figure_11():
    s = Session("figure-11", "Clones, spread three ways", "Cloned meshes along one curve as in Fig. 11: its points spread evenly, gathered at one end, gathered at both.")
    s.shape("Clones")
    s.set("item", '{\\"Component\\": \\"solid/cube\\"}')
    s.set("clones", "17")
    s.set("clone_size", "0.034")
    for y, slopes, colour in [
        (1.4, (1, 1), (201, 127, 141)),
        (1.15, (0.15, 1.6), (127, 160, 201)),
        (0.9, (0.2, 0.2), (150, 180, 120)),
    ]:
        s.slopes(*slopes)
        at = (((-0.35, y, 0), (0, 0, 55)), ((0.35, y, 0), (0, 0, -55)))
        s.sweep([at], 0.4, colour)
    s.write()


def figure_13():
    s = Session("figure-13", "A shell, a horn, a knot and a spiral", "Results of the paper's kinds (Fig. 1 and 13): an open surface, two tubes, and clones over a surface.")
    s.set("smooth", "12")
    s.note("A shell: an open fan whose outer end goes round and rises.")
    s.shape("Surface")
    ways = []
    for i in range(15):
        t = i / 14
        a = -0.3 + 3.6 * t
        r = 0.12 + 0.16 * t
        inner = (-0.55 + 0.03 * cos(a), 1.25 + 0.05 * t, 0.03 * sin(a))
        outer = (-0.55 + r * cos(a), 1.25 + 0.16 * sin(2.2 * a) * t, r * sin(a))
        yaw = -a * 180 / pi
        ways.append(((inner, (0, yaw, 55)), (outer, (0, yaw, -40))))
    s.sweep(ways, 0.22, (226, 178, 138))
    s.note("A horn: a tube that widens as the hands go apart.")
    s.shape("Tube")
    ways = []
    for i in range(15):
        t = i / 14
        a = 2.6 * t
        middle = (0.2 + 0.2 * sin(a), 1.1 + 0.34 * t, -0.1 + 0.2 * cos(a))
        half = 0.03 + 0.1 * t * t
        yaw = a * 180 / pi * 0.5
        c, d = cos(a * 0.5), -sin(a * 0.5)
        left = (middle[0] - half * c, middle[1], middle[2] - half * d)
        right = (middle[0] + half * c, middle[1], middle[2] + half * d)
        ways.append(((left, (-70, yaw, 62)), (right, (-70, yaw, -62))))
    s.sweep(ways, 0.22, (127, 160, 201))
    s.note("A twisted ring: the hands turn about their middle while they go round.")
    ways = []
    for i in range(31):
        t = i / 30
        a = 5.4 * t
        middle = (-0.45 + 0.19 * cos(a), 0.8, 0.19 * sin(a))
        b = 2.2 * pi * t
        # Outward and up span the cross-section.
        out = (cos(a), 0, sin(a))
        off = [0.06 * (cos(b) * o + sin(b) * u) for o, u in zip(out, (0, 1, 0))]
        left = [m - o for m, o in zip(middle, off)]
        right = [m + o for m, o in zip(middle, off)]
        yaw = -a * 180 / pi
        roll = b * 180 / pi
        ways.append(((left, (0, yaw, roll + 58)), (right, (0, yaw, roll - 58))))
    s.sweep(ways, 0.16, (201, 127, 141))
    s.note("A spiral of clones over a surface.")
    s.shape("Clones")
    s.set("item", '{\\"Component\\": \\"solid/sphere\\"}')
    s.set("spread", "true")
    s.set("clones", "9")
    s.set("clone_size", "0.03")
    s.slopes(0.5, 1.5)
    ways = []
    for i in range(19):
        t = i / 18
        a = 5.0 * t
        y = 0.62 + 0.3 * t
        r0, r1 = 0.05, 0.2
        left = (0.35 + r0 * cos(a), y + 0.06, r0 * sin(a))
        right = (0.35 + r1 * cos(a), y, r1 * sin(a))
        yaw = -a * 180 / pi
        ways.append(((left, (0, yaw, 25)), (right, (0, yaw, -50))))
    s.sweep(ways, 0.2, (150, 180, 120))
    s.write()


if __name__ == "__main__":
    figure_1()
    figure_10()
    figure_11()
    figure_13()
