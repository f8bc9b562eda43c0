#!/usr/bin/env python3
"""Writes a drawing of 300 lines and 80 strokes as a session: python3 scripts/large_drawing.py > benches/sessions/drawing-380.ron

Twenty-five boxes of construction lines, three strokes round each and five from one to the next; then a hand draws
slowly among them, takes steps back, saves and opens."""

import math

steps = []
say = steps.append


def jump(p):
    say("Jump(hand: Right, to: (%.4f, %.4f, %.4f))," % p)


def line(a, b):
    jump(a)
    say("Press(Right, Act),")
    jump(b)
    say("Release(Right, Act),")


def stroke(points):
    jump(points[0])
    say("Press(Right, Act),")
    for p in points[1:]:
        jump(p)
    say("Release(Right, Act),")


EDGES = [(0, 1), (1, 3), (3, 2), (2, 0), (0, 4), (1, 5), (3, 7), (2, 6), (4, 5), (5, 7), (7, 6), (6, 4)]
boxes = [(-1.4 + 0.7 * (i % 5), 0.6 + 0.1 * (i % 2), -1.4 + 0.7 * (i // 5)) for i in range(25)]
sides = lambda i: (0.34 + 0.01 * (i % 3), 0.22 + 0.02 * (i % 4), 0.28 + 0.01 * (i % 5))
say('Ask(Mode("scaffold")),')
for i, (x, y, z) in enumerate(boxes):
    a, b, c = sides(i)
    corner = [(x + a * (k & 1), y + b * (k >> 2 & 1), z + c * (k >> 1 & 1)) for k in range(8)]
    for k, (p, q) in enumerate(EDGES):
        off = 0.006 * math.sin(7.0 * k + i)
        line(tuple(v + off for v in corner[p]), tuple(v - off for v in corner[q]))
say('Ask(Set(key: "scaffold.draws", value: "\\"Stroke\\"")),')


def ring(x, y, z, a, c):
    return [(x + a / 2 * (1 + math.cos(t)), y, z + c / 2 * (1 + math.sin(t))) for t in [2 * math.pi * k / 24 for k in range(25)]]


for i, (x, y, z) in enumerate(boxes):
    a, b, c = sides(i)
    stroke(ring(x, y, z, a, c))
    stroke(ring(x, y + b, z, a, c))
    stroke([(x + a * k / 12, y + b / 2 * (1 + math.cos(math.pi * k / 12)), z + c / 2) for k in range(13)])
for i in range(5):
    x, y, z = boxes[i]
    X, Y, Z = boxes[i + 5]
    stroke([(x + (X - x) * k / 12, y + (Y - y) * k / 12 + 0.1 * math.sin(math.pi * k / 12), z + (Z - z) * k / 12) for k in range(13)])
say("Expect(objects: 380),")
say("Wait(1.0),")
say('Ask(Set(key: "scaffold.draws", value: "\\"Line\\"")),')
for k in range(4):
    x, y, z = boxes[6 * k]
    jump((x, y, z))
    say("Press(Right, Act),")
    say("Move(hand: Right, to: (%.4f, %.4f, %.4f), over: 2.0)," % (x + 0.35, y + 0.3, z + 0.3))
    say("Release(Right, Act),")
    say("Wait(0.5),")
say('Ask(Set(key: "scaffold.draws", value: "\\"Stroke\\"")),')
x, y, z = boxes[12]
a, b, c = sides(12)
path = ring(x, y, z, a, c)
jump(path[0])
say("Press(Right, Act),")
for p in path[1:]:
    say("Move(hand: Right, to: (%.4f, %.4f, %.4f), over: 0.1)," % p)
say("Release(Right, Act),")
say("Move(hand: Right, to: (0.0, 1.2, 0.8), over: 2.0),")
for k in range(10):
    say("Ask(Undo),")
    say("Wait(0.1),")
for k in range(10):
    say("Ask(Redo),")
    say("Wait(0.1),")
say("Wait(1.0),")
print("// A drawing of 300 construction lines and 80 strokes, made by a hand that jumps; then a hand draws among them, and steps are")
print("// taken back and again. scripts/large_drawing.py wrote it.")
print("// Frame figures: midair play benches/sessions/drawing-380.ron --paced --report report.json --save drawing.midair")
print("(\n    format: 1,\n    title: \"300 lines and 80 strokes\",\n    steps: [")
for step in steps:
    print("        " + step)
print("    ],\n)")
