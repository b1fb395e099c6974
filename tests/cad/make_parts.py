"""Makes random parts with FreeCAD, by fourteen kinds of operations, and writes them as STEP and IGES.

  SEED=1 COUNT=6 FOLDER=parts freecadcmd tests/cad/make_parts.py

Each part is made in a process of its own, because FreeCAD ends with a fault on some of them. COUNT parts
of each kind: solids added and cut, fillets and chamfers, pockets with holes, lofts of splines and of
circles, sweeps, solids of revolution, shells, domes, threads, stretched solids, slanting ellipses, offset
sheets, assemblies with mirrored parts. The same seed gives the same parts. parts.json in the folder has
the number of faces of each that FreeCAD finds valid, also after it has read its own STEP file again;
others are not written. FreeCAD runs this file as a module, so all settings are variables.
"""

import json
import math
import os
import pathlib
import random
import subprocess

import FreeCAD
import Part
from FreeCAD import Vector

UP = Vector(0, 0, 1)


def turned(r):
    return FreeCAD.Rotation(Vector(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)), r.uniform(0, 360))


def primitive(r, size=20.0):
    kind = r.choice(["box", "cylinder", "cone", "sphere", "torus", "wedge"])
    if kind == "box":
        made = Part.makeBox(r.uniform(5, size), r.uniform(5, size), r.uniform(5, size))
    elif kind == "cylinder":
        made = Part.makeCylinder(r.uniform(2, size / 2), r.uniform(5, 2 * size))
    elif kind == "cone":
        made = Part.makeCone(r.uniform(2, size / 2), r.choice([0, r.uniform(1, size / 3)]), r.uniform(5, size))
    elif kind == "sphere":
        made = Part.makeSphere(r.uniform(3, size / 2))
    elif kind == "torus":
        made = Part.makeTorus(r.uniform(6, size / 1.5), r.uniform(1, 4))
    else:
        made = Part.makeWedge(0, 0, 0, 2, 2, r.uniform(8, size), r.uniform(8, size), r.uniform(5, size), r.uniform(5, 7),
                              r.uniform(5, 7))
    place = Vector(r.uniform(-10, 10), r.uniform(-10, 10), r.uniform(-10, 10))
    if r.random() < 0.5:
        made.Placement = FreeCAD.Placement(place, turned(r))
    else:  # on whole millimetres, where faces of several solids coincide
        made.Placement = FreeCAD.Placement(Vector(round(place.x), round(place.y), round(place.z)), FreeCAD.Rotation())
    return made


def rounded(solid, radius, edges):
    """The solid with fillets, or as it was where FreeCAD cannot make them."""
    try:
        made = solid.makeFillet(radius, edges)
    except Exception:
        return solid
    return made if made.isValid() and made.Volume > 0 else solid


def booleans(r):
    solid = Part.makeBox(40, 40, 15, Vector(-20, -20, -10))
    for _ in range(r.randint(2, 6)):
        solid = r.choice([solid.fuse, solid.cut, solid.cut])(primitive(r))
    return solid


def filleted(r):
    solid = booleans(r)
    edges = list(solid.Edges)
    r.shuffle(edges)
    for edge in edges[:r.randint(2, 10)]:
        made = rounded(solid, r.uniform(0.3, 2.0), [edge])
        if made is not solid:
            solid = made
            break
    return rounded(solid, 0.4, [e for e in solid.Edges if e.Length > 3][:r.randint(3, 12)])


def is_upright(edge):
    return abs(edge.tangentAt(edge.FirstParameter).z) > 0.9


def pocket(r):
    solid = Part.makeBox(80, 60, 25)
    for _ in range(r.randint(1, 4)):
        depth = r.uniform(4, 20)
        hollow = Part.makeBox(r.uniform(8, 20), r.uniform(8, 15), depth + 1,
                              Vector(r.uniform(10, 60), r.uniform(10, 45), 25 - depth))
        solid = solid.cut(rounded(hollow, r.uniform(1, 3), [e for e in hollow.Edges if is_upright(e)]))
    for _ in range(r.randint(0, 5)):
        solid = solid.cut(Part.makeCylinder(r.uniform(1, 4), 30, Vector(r.uniform(5, 75), r.uniform(5, 55), -1)))
    top = [e for e in solid.Edges if e.Length > 1 and abs(e.BoundBox.ZMin - 25) < 1e-6 and abs(e.BoundBox.ZMax - 25) < 1e-6]
    return rounded(solid, 0.8, top)


def spline_ring(r, z, count, radius):
    points = []
    for k in range(count):
        angle, out = 2 * math.pi * k / count, radius + r.uniform(-3, 3)
        points.append(Vector(out * math.cos(angle), out * math.sin(angle), z))
    curve = Part.BSplineCurve()
    curve.interpolate(points, PeriodicFlag=True)
    return Part.Wire(curve.toShape())


def loft(r):
    rings = [spline_ring(r, 12 * k + r.uniform(0, 2), r.randint(5, 9), 15) for k in range(r.randint(2, 4))]
    return Part.makeLoft(rings, True, r.random() < 0.3)


def circle_loft(r):
    rings = [Part.Wire(Part.makeCircle(r.uniform(5, 15), Vector(r.uniform(-3, 3), r.uniform(-3, 3), 10 * k),
                                       Vector(r.uniform(-0.2, 0.2), r.uniform(-0.2, 0.2), 1)))
             for k in range(r.randint(2, 5))]
    return Part.makeLoft(rings, True, False)


def sweep(r):
    points = [Vector(0, 0, 0)]
    points += [Vector(10 * k + r.uniform(-3, 3), r.uniform(-8, 8), r.uniform(-8, 8)) for k in range(1, r.randint(3, 6))]
    curve = Part.BSplineCurve()
    curve.interpolate(points)
    along = curve.tangent(curve.FirstParameter)[0]
    if r.random() < 0.5:
        profile = Part.Wire(Part.makeCircle(r.uniform(1, 3), Vector(0, 0, 0), along))
    else:
        profile = Part.makePlane(4, 3, Vector(0, 0, 0), along).OuterWire
    return Part.Wire(curve.toShape()).makePipeShell([profile], True, r.random() < 0.5)


def revolution(r):
    points = [Vector(3, 0, 0)] + [Vector(8 + r.uniform(-4, 4), 0, 5 * k) for k in range(1, r.randint(3, 7))]
    curve = Part.BSplineCurve()
    curve.interpolate(points)
    top = points[-1]
    axis = Vector(0, 0, top.z)
    profile = Part.Wire([curve.toShape(), Part.makeLine(top, axis), Part.makeLine(axis, Vector(0, 0, 0)),
                         Part.makeLine(Vector(0, 0, 0), points[0])])
    return Part.Face(profile).revolve(Vector(0, 0, 0), UP, r.choice([360, 360, 200, 90]))


def shell(r):
    solid = Part.makeBox(40, 30, 20)
    solid = rounded(solid, r.uniform(2, 5), [e for e in solid.Edges if is_upright(e)])
    top = [f for f in solid.Faces if abs(f.BoundBox.ZMin - 20) < 1e-6]
    return solid.makeThickness(top, -r.uniform(1, 2.5), 1e-3)


def dome(r):
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(10 * i, 10 * j, 5 + r.uniform(-4, 4)) for j in range(6)] for i in range(7)])
    solid = Part.makeBox(60, 50, 30, Vector(0, 0, -15)).common(surface.toShape().extrude(Vector(0, 0, -40)))
    for _ in range(r.randint(0, 4)):
        solid = solid.cut(Part.makeCylinder(r.uniform(1.5, 6), 60, Vector(r.uniform(8, 52), r.uniform(8, 42), -30)))
    return solid


def thread(r):
    helix = Part.makeHelix(r.uniform(2, 4), r.uniform(8, 16), 8)
    corners = [Vector(7.6, 0, -0.9), Vector(7.6, 0, 0.9), Vector(9, 0, 0.2), Vector(9, 0, -0.2), Vector(7.6, 0, -0.9)]
    ridge = Part.Wire(helix.Edges).makePipeShell([Part.Wire(Part.makePolygon(corners))], True, True)
    return Part.makeCylinder(8, 20, Vector(0, 0, -1)).fuse(ridge)


def stretched(r):
    matrix = FreeCAD.Matrix()
    matrix.scale(r.uniform(0.5, 2), r.uniform(0.5, 2), r.uniform(0.5, 2))
    return booleans(r).transformGeometry(matrix)


def ellipse(r):
    outline = Part.Ellipse(Vector(0, 0, 0), r.uniform(10, 20), r.uniform(4, 9)).toShape()
    solid = Part.Face(Part.Wire(outline)).extrude(Vector(r.uniform(-3, 3), r.uniform(-3, 3), 15))
    return rounded(solid, 1.0, solid.Edges[:3]).cut(Part.makeSphere(8, Vector(5, 2, 15)))


def offset_sheet(r):
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(10 * i, 10 * j, 6 * math.sin(0.7 * i + r.random()) + 3 * math.cos(j)) for j in range(5)]
                         for i in range(6)])
    return surface.toShape().makeOffsetShape(r.uniform(-1.5, 1.5), 1e-4)


def assembly(r):
    part, other = filleted(r), pocket(r)
    other.Placement = FreeCAD.Placement(Vector(0, 70, 0), turned(r))
    return Part.makeCompound([part, part.mirror(Vector(60, 0, 0), Vector(1, 0, 0)), other])


KINDS = [booleans, filleted, pocket, loft, circle_loft, sweep, revolution, shell, dome, thread, stretched, ellipse, offset_sheet,
         assembly]


def make(kind, seed, folder):
    """The part's number of faces, or None where FreeCAD does not make a valid one."""
    try:
        shape = kind(random.Random(seed))
    except Exception:
        return None
    if shape.isNull() or not shape.Faces or not shape.isValid():
        return None
    part = folder / f"{seed}.step"
    shape.exportStep(str(part))
    again = Part.Shape()
    again.read(str(part))
    if not again.isValid():
        part.unlink()
        return None
    shape.exportIges(str(folder / f"{seed}.iges"))
    return len(shape.Faces)


def main():
    folder = pathlib.Path(os.environ.get("FOLDER", "parts"))
    seed = os.environ.get("SEED", "1")
    if "PART" in os.environ:  # one of them, in a process of its own
        kind, k = os.environ["PART"].split(":")
        name = f"{kind}_{seed}_{k}"
        count = make({made.__name__: made for made in KINDS}[kind], name, folder)
        if count is not None:
            (folder / f"{name}.json").write_text(json.dumps({name: count}))
        return
    folder.mkdir(parents=True, exist_ok=True)
    for kind in KINDS:
        for k in range(int(os.environ.get("COUNT", "6"))):
            subprocess.run(["freecadcmd", os.path.abspath(__file__)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           env={**os.environ, "PART": f"{kind.__name__}:{k}"}, check=False)
    faces = {}
    for stated in sorted(folder.glob("*_*.json")):
        faces.update(json.loads(stated.read_text()))
        stated.unlink()
    for part in folder.glob("*_*.*"):  # of processes that ended with a fault
        if part.stem not in faces:
            part.unlink()
    (folder / "parts.json").write_text(json.dumps(faces, indent=1))
    print(f"{len(faces)} parts in {folder}")


main()
