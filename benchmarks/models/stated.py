"""What a URDF or SDF file says of a robot with two driven wheels, read with ElementTree and numpy: shares nothing with the product."""

import math
import xml.etree.ElementTree as tree

import numpy as np


def turned(roll, pitch, yaw):
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]])


def frame(numbers):
    """4 x 4 of x y z roll pitch yaw, or of x y z and a quaternion x y z w."""
    matrix = np.eye(4)
    matrix[:3, 3] = numbers[:3]
    if len(numbers) == 7:
        x, y, z, w = np.array(numbers[3:]) / np.linalg.norm(numbers[3:])
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        matrix[:3, :3] = np.eye(3) + 2 * w * cross + 2 * cross @ cross
    else:
        matrix[:3, :3] = turned(*numbers[3:])
    return matrix


def floats(text, otherwise=""):
    return [float(word) for word in (text or otherwise).split()]


class Part:
    """A link in the model's frame: mass, center of mass, inertia about it, and shapes (kind, frame, sizes)."""

    def __init__(self, pose):
        self.pose, self.mass, self.center, self.inertia, self.shapes = pose, None, np.zeros(3), np.zeros((3, 3)), []

    def weigh(self, mass, at, moments):
        xx, xy, xz, yy, yz, zz = moments
        self.mass, self.center = mass, at[:3, 3]
        self.inertia = at[:3, :3] @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ at[:3, :3].T


MOMENTS = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]


class Urdf:
    """Links by name, joints by name: (type, parent, child, place, axis)."""

    def __init__(self, root):
        above = {j.find("child").get("link"): j for j in root.findall("joint")}

        def origin(element):
            at = element.find("origin") if element is not None else None
            return frame(floats(at.get("xyz"), "0 0 0") + floats(at.get("rpy"), "0 0 0")) if at is not None else np.eye(4)

        def pose(link):
            joint = above.get(link)
            return np.eye(4) if joint is None else pose(joint.find("parent").get("link")) @ origin(joint)

        self.links, self.joints = {}, {}
        for element in root.findall("link"):
            part = self.links[element.get("name")] = Part(pose(element.get("name")))
            inertial = element.find("inertial")
            if inertial is not None:
                moments = inertial.find("inertia").attrib
                part.weigh(float(inertial.find("mass").get("value")), part.pose @ origin(inertial), [float(moments.get(m, 0)) for m in MOMENTS])
            for collision in element.findall("collision"):
                for shape in collision.find("geometry"):
                    part.shapes.append((shape.tag, part.pose @ origin(collision), {k: floats(v) for k, v in shape.attrib.items() if k in ("size", "radius", "length")}))
        for child, joint in above.items():
            at, axis = pose(child), joint.find("axis")
            turn = np.array(floats(axis.get("xyz")) if axis is not None else [1, 0, 0])
            self.joints[joint.get("name")] = (joint.get("type"), joint.find("parent").get("link"), child, at[:3, 3], at[:3, :3] @ turn)


class Sdf:
    def __init__(self, root):
        models = [m for m in root.iter("model") if m.find("link") is not None]
        driving = [m for m in models if any("diff" in (p.get("filename") or "").lower() for p in m.findall("plugin"))]
        self.model = (driving or models)[0]
        self.named = {e.get("name"): e for kind in ("frame", "joint", "link") for e in self.model.findall(kind)}
        before_15 = float(root.get("version")) < 1.5
        self.links, self.joints = {}, {}
        for element in self.model.findall("link"):
            part = self.links[element.get("name")] = Part(self.pose(element))
            inertial = element.find("inertial")
            if inertial is not None and inertial.find("mass") is not None:
                inertia = inertial.find("inertia")
                moments = [1, 0, 0, 1, 0, 1] if inertia is None else [float(inertia.findtext(m, "1" if m[1] == m[2] else "0")) for m in MOMENTS]
                part.weigh(float(inertial.findtext("mass")), self.pose(inertial, part.pose), moments)
            for collision in element.findall("collision"):
                for shape in collision.find("geometry"):
                    part.shapes.append((shape.tag, self.pose(collision, part.pose), {s.tag: floats(s.text) for s in shape if s.tag in ("size", "radius", "length")}))
        for joint in self.model.findall("joint"):
            at, axis = self.pose(joint), joint.find("axis")
            turn = np.array(floats(axis.findtext("xyz"), "0 0 1") if axis is not None else [0, 0, 1])
            direct = axis is not None and axis.findtext("use_parent_model_frame", str(before_15)).lower() in ("1", "true")
            self.joints[joint.get("name")] = (joint.get("type"), joint.findtext("parent").strip(), joint.findtext("child").strip(), at[:3, 3], turn if direct else at[:3, :3] @ turn)

    def pose(self, element, base=None):
        at = element.find("pose")
        text = (at.text or "").split() if at is not None else []
        numbers = [float(word) for word in text] or [0.0] * 6
        if at is not None and at.get("degrees") in ("1", "true"):
            numbers[3:] = [math.radians(angle) for angle in numbers[3:]]
        on = at.get("relative_to") if at is not None else None
        if not on and element.tag == "joint":
            on = element.findtext("child").strip()
        if not on and element.tag == "frame":
            on = element.get("attached_to")
        if on and on != "__model__":
            base = self.pose(self.named[on])
        return (np.eye(4) if base is None else base) @ frame(numbers)


def reach(shape, direction):
    """How far a shape extends along a direction (m from the origin), exactly; None for a mesh."""
    kind, at, sizes = shape
    along = at[:3, :3].T @ direction
    center = at[:3, 3] @ direction
    if kind == "box":
        return center + np.abs(along) @ sizes["size"] / 2
    if kind == "sphere":
        return center + sizes["radius"][0]
    if kind in ("cylinder", "capsule"):
        round_m = sizes["radius"][0] * (1 if kind == "capsule" else np.hypot(along[0], along[1]))
        return center + abs(along[2]) * sizes["length"][0] / 2 + round_m
    return None


def stated(file, wheels):
    """Values of a robot file by name, and `sides`: reach forward, backward, left, right of the axle's middle; None: not stated."""
    root = tree.parse(file).getroot()
    model = Urdf(root) if root.tag == "robot" else Sdf(root)
    ends, wheel_links, masses, rolling, radii = [], set(), [], [], []
    for name in wheels:
        _, _, child, place, axis = model.joints[name]
        axis = axis / np.linalg.norm(axis)
        group, known = {child}, 0
        while known != len(group):
            known = len(group)
            group |= {c for kind, p, c, _, _ in model.joints.values() if p in group and kind == "fixed"}
        parts = [model.links[n] for n in model.links if n in group]
        wheel_links |= group
        heavy = [p for p in parts if p.mass is not None]
        mass, center, inertia = together(heavy) if heavy else (None, None, None)
        masses.append(mass)
        rolling.append(axis @ inertia @ axis if heavy else None)
        rounds = [s for p in parts for s in p.shapes if s[0] in ("cylinder", "sphere", "capsule")]
        radii.append(rounds[0][2]["radius"][0] if rounds else None)
        ends.append(place + axis * (axis @ (rounds[0][1][:3, 3] - place)) if rounds else place)
    middle, across = (ends[0] + ends[1]) / 2, ends[0] - ends[1]
    left = across / np.linalg.norm(across)
    forward = np.cross(left, [0, 0, 1])
    forward /= np.linalg.norm(forward)
    chassis = [p for n, p in model.links.items() if n not in wheel_links and p.mass is not None]
    values = {"half_track_m": np.linalg.norm(across) / 2}
    if chassis and sum(p.mass for p in chassis) > 0:
        mass, center, inertia = together(chassis)
        values |= {"chassis_mass_kg": mass, "chassis_yaw_inertia_kg_m2": inertia[2, 2], "center_of_mass_offset_m": (center - middle) @ forward}
    for key, pair in (("wheel_mass_kg", masses), ("wheel_axle_inertia_kg_m2", rolling), ("wheel_radius_m", radii)):
        if None not in pair:
            values[key] = sum(pair) / 2
    if None in radii and root.find(".//wheel_diameter") is not None:
        values["wheel_radius_m"] = float(root.find(".//wheel_diameter").text) / 2
    return values | reached([s for p in model.links.values() for s in p.shapes], left, middle)


def reached(shapes, left, middle):
    """`sides` of shapes seen from above; nothing where a shape is a mesh."""
    forward = np.cross(left, [0, 0, 1])
    directions = [d / np.linalg.norm(d) for d in (forward, -forward, left, -left)]
    sides = [[reach(s, d) for s in shapes] for d in directions]
    if not shapes or any(r is None for side in sides for r in side):
        return {}
    return {"sides": [max(side) - middle @ d for side, d in zip(sides, directions)]}


def together(parts):
    """Mass, center of mass and inertia about it of several links (parallel axes)."""
    mass = sum(p.mass for p in parts)
    if mass == 0:
        return 0.0, np.zeros(3), sum(p.inertia for p in parts)
    center = sum(p.mass * p.center for p in parts) / mass
    inertia = np.zeros((3, 3))
    for p in parts:
        x, y, z = p.center - center
        inertia += p.inertia + p.mass * np.array([[y * y + z * z, -x * y, -x * z], [-x * y, x * x + z * z, -y * z], [-x * z, -y * z, x * x + y * y]])
    return mass, center, inertia
