"""Reads the tiles of `tellus tiles` by the words of the standards alone, and compares them with `tellus sample`.

Usage: python3 scripts/read_tiles.py FOLDER PRESET COMMAND...

COMMAND runs tellus. Tiles may be listed or implicit, and their vertices floats or whole numbers. Checked are: each tile
lies within its box, tiles that subtrees tell of are there with their parents, and vertices of the surface lie where the
ground or the water is, within half a step along each axis.
"""

import itertools
import json
import math
import struct
import subprocess
import sys
from pathlib import Path

FACES = ["pos_x", "neg_x", "pos_y", "neg_y", "pos_z", "neg_z"]
# Vertices of a tile that are compared with samples, and how near they must be besides half a step, in metres: floats of
# 32 bits are so far apart on a tile as wide as a moon.
COMPARED = 12
NEAR_M = 0.1


def check(holds, words):
    if not holds:
        sys.exit(f"error: {words}")


class Glb:
    """Binary glTF 2.0 with KHR_mesh_quantization."""

    KINDS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
    # Format, bytes, and what stands for 1.
    COMPONENTS = {
        5120: ("b", 1, 127),
        5121: ("B", 1, 255),
        5122: ("h", 2, 32767),
        5123: ("H", 2, 65535),
        5125: ("I", 4, 1),
        5126: ("f", 4, 1),
    }

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", data)
        check((magic, version, length) == (b"glTF", 2, len(data)), f"{path}: the head")
        (size,) = struct.unpack_from("<I", data, 12)
        self.json = json.loads(data[20 : 20 + size])
        self.binary = data[28 + size :]
        known = {"KHR_mesh_quantization"}
        check(set(self.json.get("extensionsRequired", [])) <= known, f"{path}: unknown extensions")

    def numbers(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        letter, size, one = self.COMPONENTS[accessor["componentType"]]
        count = self.KINDS[accessor["type"]]
        stride = view.get("byteStride", size * count)
        # Vertices begin at multiples of four bytes.
        check("target" not in view or view["target"] != 34962 or stride % 4 == 0, f"a stride of {stride}")
        check(accessor["count"] * stride <= view["byteLength"], "a view is too short")
        start = view["byteOffset"] + accessor.get("byteOffset", 0)
        starts = range(start, start + accessor["count"] * stride, stride)
        rows = [struct.unpack_from(f"<{count}{letter}", self.binary, at) for at in starts]
        for key, pick in [("min", min), ("max", max)]:
            if key in accessor:
                check([pick(column) for column in zip(*rows)] == accessor[key], f"the {key} of an accessor")
        if accessor.get("normalized"):
            rows = [tuple(max(number / one, -1) for number in row) for row in rows]
        return rows

    def surface(self):
        """Positions in the planet frame, metres, and the greatest error of a coordinate."""
        root = self.json["nodes"][0]
        node = self.json["nodes"][root["children"][0]]
        (primitive,) = self.json["meshes"][node["mesh"]]["primitives"]
        scale = node.get("scale", [1, 1, 1])
        rows = self.numbers(primitive["attributes"]["POSITION"])
        for normal in self.numbers(primitive["attributes"]["NORMAL"]):
            check(abs(math.hypot(*normal) - 1) < 0.007, f"a normal of the length {math.hypot(*normal)}")
        triangles = self.numbers(primitive["indices"])
        check(max(triangles)[0] == len(rows) - 1, "an index is of no vertex")
        positions = [[n * s + t for n, s, t in zip(row, scale, root["translation"])] for row in rows]
        is_short = "KHR_mesh_quantization" in self.json.get("extensionsUsed", [])
        # Up is y in glTF and z in 3D Tiles.
        return [(x, -z, y) for x, y, z in positions], 0.5 * scale[0] if is_short else 0.0


def subtree(path, levels):
    """Boxes of the tiles that a subtree file tells of, by level, column and row."""
    data = path.read_bytes()
    magic, version, json_length, binary_length = struct.unpack_from("<4sIQQ", data)
    check((magic, version) == (b"subt", 1) and len(data) == 24 + json_length + binary_length, f"{path}: the head")
    check(json_length % 8 == 0 and binary_length % 8 == 0, f"{path}: lengths")
    told = json.loads(data[24 : 24 + json_length])

    def view(index):
        found = told["bufferViews"][index]
        check(found["byteOffset"] % 8 == 0, f"{path}: a view begins at {found['byteOffset']}")
        return data[24 + json_length + found["byteOffset"] :][: found["byteLength"]]

    places = (4**levels - 1) // 3
    available = told["tileAvailability"]
    check(told["contentAvailability"] == [available] and told["childSubtreeAvailability"] == {"constant": 0}, path)
    if "constant" in available:
        bits = [available["constant"] == 1] * places
    else:
        stream = view(available["bitstream"])
        check(len(stream) == (places + 7) // 8, f"{path}: {len(stream)} bytes of bits")
        bits = [stream[i // 8] >> i % 8 & 1 == 1 for i in range(places)]
        check(sum(bits) == available["availableCount"], f"{path}: {sum(bits)} bits")
    table = told["propertyTables"][told["tileMetadata"]]
    check(table["count"] == sum(bits), f"{path}: {table['count']} rows")
    numbers = view(table["properties"]["bounds"]["values"])
    boxes = iter(struct.iter_unpack("<12d", numbers))
    tiles = {}
    place = 0
    for level in range(levels):
        for curve in range(4**level):
            if bits[place]:
                x = sum((curve >> 2 * i & 1) << i for i in range(level))
                y = sum((curve >> 2 * i + 1 & 1) << i for i in range(level))
                check(level == 0 or (level - 1, x // 2, y // 2) in tiles, f"{path}: a tile without a parent")
                tiles[level, x, y] = next(boxes)
            place += 1
    check(next(boxes, None) is None, f"{path}: a box without a tile")
    return tiles


def tiles_of(folder, tile):
    """Places of the files of a tile and of all that it is divided into, with their boxes."""
    uri = tile["content"]["uri"]
    implicit = tile.get("implicitTiling")
    if implicit is None:
        yield uri, tile["boundingVolume"]["box"]
        for child in tile.get("children", []):
            yield from tiles_of(folder, child)
        return

    def fill(template, level, x, y):
        return template.replace("{level}", str(level)).replace("{x}", str(x)).replace("{y}", str(y))

    file = folder / fill(implicit["subtrees"]["uri"], 0, 0, 0)
    check(implicit["subdivisionScheme"] == "QUADTREE", "a scheme")
    for place, box in subtree(file, implicit["subtreeLevels"]).items():
        yield fill(uri, *place), box


def share_of_box(point, box):
    """How far out a point is: 1 on a side of the box."""
    away = [p - c for p, c in zip(point, box)]
    axes = [box[3:6], box[6:9], box[9:12]]
    return max(abs(sum(a * b for a, b in zip(away, axis))) / sum(a * a for a in axis) for axis in axes)


def direction(uri, u, v):
    """The unit vector at a place of a tile, 0 to 1 to the right and upwards (src/sphere/cube.rs)."""
    level, name = uri.removesuffix(".glb").split("/")
    face, x, y = name.rsplit("_", 2)
    number = FACES.index(face)
    axis, sign = number // 2, 1 - number % 2 * 2

    def bend(place, share):
        w = (int(place) + share) / 2 ** int(level) * 2 - 1
        return w / math.sqrt(1 + 0.87**2 * (1 - w * w))

    p = [0.0] * 3
    p[axis] = sign
    p[(axis + 1) % 3] = bend(x, u) * sign
    p[(axis + 2) % 3] = bend(y, v)
    return [c / math.hypot(*p) for c in p]


def main():
    folder, preset, command = Path(sys.argv[1]), sys.argv[2], sys.argv[3:]
    tileset = json.loads((folder / "tileset.json").read_text())
    check(tileset["asset"]["version"] == "1.1", "the version")
    radius_m = tileset["asset"]["extras"]["radius_m"]
    tiles = list(itertools.chain.from_iterable(tiles_of(folder, face) for face in tileset["root"]["children"]))
    wanted = []
    greatest_m = 0.0
    for number, (uri, box) in enumerate(tiles):
        positions, error_m = Glb(folder / uri).surface()
        greatest_m = max(greatest_m, error_m)
        out = max(share_of_box(position, box) for position in positions)
        check(out <= 1, f"{uri}: {out} of its box")
        # A square of vertices from its upper left corner, and those of the skirt.
        side = round(math.sqrt(len(positions) + 8)) - 2
        check(side * side + 4 * (side - 1) == len(positions), f"{uri}: {len(positions)} vertices")
        for i in range(COMPARED):
            place = (number * 7919 + i * 104_729) % (side * side)
            dir = direction(uri, place % side / (side - 1), 1 - place // side / (side - 1))
            wanted.append((uri, dir, positions[place], error_m))
    lines = [f"{math.degrees(math.asin(z))!r},{math.degrees(math.atan2(y, x))!r}" for _, (x, y, z), _, _ in wanted]
    command = [*command, "sample", preset, "--points", "-"]
    answers = subprocess.run(command, input="\n".join(lines), capture_output=True, text=True, check=True).stdout
    worst_m = 0.0
    for (uri, dir, position, error_m), line in zip(wanted, answers.splitlines(), strict=True):
        answer = json.loads(line)
        levels_m = [answer["height_m"], answer.get("water_level_m")]
        height_m = max(level_m for level_m in levels_m if level_m is not None)
        away_m = max(abs(p - c * (radius_m + height_m)) for p, c in zip(position, dir))
        check(away_m <= error_m + NEAR_M, f"{uri}: {away_m} m from the surface, not {error_m}")
        worst_m = max(worst_m, away_m)
    vertices = f"{len(wanted)} vertices within {worst_m:.2f} m of samples"
    print(f"{len(tiles)} tiles, {vertices}; half a step is {greatest_m:.2f} m at most")


main()
