"""Prints the ground under some places, the extent of a tile, clouds, water and a falling ball at a time, and objects.

Build the library first (docs/embedding.md), then: python3 examples/embed/heights.py target/debug/libtellus.so
"""

import ctypes
import math
import sys
from ctypes import POINTER, byref, c_bool, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint32, c_uint64
from ctypes import c_void_p

SIDE = 33


class Sample(ctypes.Structure):
    _fields_ = [
        ("height_m", c_double),
        ("water_level_m", c_double),
        ("normal", c_double * 3),
        ("slope_rad", c_double),
        ("temperature_c", c_double),
        ("rain_mm", c_double),
        ("biome", c_uint32),
    ]


class Clouds(ctypes.Structure):
    _fields_ = [("low", c_double), ("middle", c_double), ("veil", c_double), ("fog", c_double)]


class Contact(ctypes.Structure):
    _fields_ = [("share", c_double), ("gap_m", c_double), ("point_m", c_double * 3), ("normal", c_double * 3)]


class Instance(ctypes.Structure):
    _fields_ = [
        ("id", c_uint64),
        ("seed", c_uint32),
        ("population", c_uint32),
        ("direction", c_double * 3),
        ("ground_m", c_double),
        ("base_m", c_double),
        ("axis", c_double * 3),
        ("turn_rad", c_double),
        ("size_m", c_double),
        ("brightness", c_double),
        ("variant", c_uint32),
        ("reserved", c_uint32),
    ]


class Object(ctypes.Structure):
    _fields_ = [("id", c_uint64), ("seed", c_uint32), ("reserved", c_uint32)]


def load(path):
    library = ctypes.CDLL(path)
    numbers = POINTER(c_double)
    signatures = {
        "tellus_last_error": (c_char_p, []),
        "tellus_planet_from_file": (c_void_p, [c_char_p, c_char_p]),
        "tellus_planet_free": (None, [c_void_p]),
        "tellus_name": (c_char_p, [c_void_p]),
        "tellus_hash": (c_char_p, [c_void_p]),
        "tellus_radius_m": (c_double, [c_void_p]),
        "tellus_biome_name": (c_char_p, [c_void_p, c_uint32]),
        "tellus_direction": (c_bool, [c_double, c_double, numbers]),
        "tellus_samples": (c_bool, [c_void_p, numbers, c_size_t, POINTER(Sample)]),
        "tellus_tile": (c_bool, [c_void_p] + [c_uint32] * 5 + [numbers, POINTER(c_float)]),
        "tellus_clouds": (c_bool, [c_void_p, numbers, c_size_t, c_double, POINTER(Clouds)]),
        "tellus_water": (c_bool, [c_void_p, numbers, c_size_t, c_double, numbers]),
        "tellus_chunk": (
            c_bool,
            [c_void_p, numbers, c_double, c_uint32, c_int32, c_int32, POINTER(c_float), POINTER(c_float)],
        ),
        "tellus_population_name": (c_char_p, [c_void_p, c_uint32]),
        "tellus_instances": (c_int64, [c_void_p, numbers, c_double, POINTER(Instance), c_size_t]),
        "tellus_nearest_object": (c_int32, [c_void_p, numbers, c_double, c_int32, POINTER(Instance)]),
        "tellus_objects": (c_void_p, [c_void_p]),
        "tellus_objects_free": (None, [c_void_p]),
        "tellus_objects_raycast": (c_double, [c_void_p, numbers, numbers, c_double, numbers, POINTER(Object)]),
        "tellus_objects_hide": (c_int64, [c_void_p, POINTER(Object), c_size_t]),
        "tellus_objects_hidden": (c_int64, [c_void_p, POINTER(Object), c_size_t]),
        "tellus_sweep": (c_int32, [c_void_p, numbers, c_double, numbers, c_double, POINTER(Contact)]),
    }
    for name, (result, arguments) in signatures.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


def room_for(kind, directions):
    """Room for an answer to each direction. The library cannot see how long a buffer is: it is checked here."""
    if len(directions) % 3 != 0:
        raise ValueError(f"directions have three numbers each, not {len(directions)} in all")
    return (kind * (len(directions) // 3))()


def main():
    tellus = load(sys.argv[1])

    def check(answer):
        if not answer:
            sys.exit("error: " + tellus.tellus_last_error().decode())
        return answer

    path = sys.argv[2] if len(sys.argv) > 2 else "planets/pallor.ron"
    planet = check(tellus.tellus_planet_from_file(path.encode(), None))
    print(tellus.tellus_name(planet).decode(), tellus.tellus_hash(planet).decode())

    places = [(48.2, 16.4), (-33.9, 151.2), (0.0, -78.5)]
    directions = (c_double * (3 * len(places)))()
    for index, (lat_deg, lon_deg) in enumerate(places):
        direction = (c_double * 3)()
        check(tellus.tellus_direction(lat_deg, lon_deg, direction))
        directions[3 * index : 3 * index + 3] = direction[:]
    samples = room_for(Sample, directions)
    check(tellus.tellus_samples(planet, directions, len(samples), samples))
    for sample in samples:
        print(f"{sample.height_m:.3f} {tellus.tellus_biome_name(planet, sample.biome).decode()}")

    positions_m = (c_double * (3 * SIDE * SIDE))()
    check(tellus.tellus_tile(planet, 0, 4, 3, 5, SIDE, positions_m, None))
    radius_m = tellus.tellus_radius_m(planet)
    heights_m = [math.hypot(*positions_m[i : i + 3]) - radius_m for i in range(0, len(positions_m), 3)]
    print(f"tile {min(heights_m):.3f} {max(heights_m):.3f}")

    # What a game asks at each moment.
    time_s = 5000.0
    clouds = room_for(Clouds, directions)
    check(tellus.tellus_clouds(planet, directions, len(clouds), time_s, clouds))
    for index, sample in enumerate(samples):
        direction = (c_double * 3)(*directions[3 * index : 3 * index + 3])
        water_m = c_double()
        check(tellus.tellus_water(planet, direction, 1, time_s, byref(water_m)))
        start_m = [c * (radius_m + sample.height_m + 1000.0) for c in direction]
        contact = Contact()
        ends_m, motion_m = (c_double * 6)(*start_m, *start_m), (c_double * 3)(*[c * -2000.0 for c in direction])
        touches = tellus.tellus_sweep(planet, ends_m, 2.0, motion_m, 0.0, byref(contact))
        check(touches == 1)
        cover = clouds[index]
        water = "dry" if math.isnan(water_m.value) else f"water {water_m.value:.3f}"
        falls = f"falls by {contact.share * 2000.0:.3f}"
        print(f"clouds {cover.low:.4f} {cover.middle:.4f} {cover.veil:.4f}, {water}, {falls}")

    chunk_m, normals = (c_float * (3 * 81))(), (c_float * (3 * 81))()
    first = (c_double * 3)(*directions[:3])
    check(tellus.tellus_chunk(planet, first, 100.0, 8, -1, 2, chunk_m, normals))
    print("chunk " + " ".join(f"{c:.3f}" for c in chunk_m[240:]))
    print_objects(tellus, check, planet, directions)
    tellus.tellus_planet_free(planet)


def print_objects(tellus, check, planet, directions):
    """Plants and stones around places. The nearest one of the first population is hit from above, and hidden."""
    objects = check(tellus.tellus_objects(planet))
    for index in range(0, len(directions), 3):
        direction = (c_double * 3)(*directions[index : index + 3])
        count = tellus.tellus_instances(planet, direction, 30.0, None, 0)
        check(count >= 0)
        around = (Instance * count)()
        check(tellus.tellus_instances(planet, direction, 30.0, around, count) == count)
        ids = [instance.id for instance in around]
        assert ids == sorted(ids)
        print(f"objects {count}")
        nearest = Instance()
        there = tellus.tellus_nearest_object(planet, direction, 5000.0, 0, byref(nearest))
        check(there >= 0)
        if there == 0:
            continue
        name = tellus.tellus_population_name(planet, nearest.population).decode()
        print(f"nearest {name} {nearest.id} {nearest.size_m:.3f}")
        over_m = tellus.tellus_radius_m(planet) + nearest.base_m + 2.0 * nearest.size_m
        above_m, down = (c_double * 3)(*[c * over_m for c in nearest.direction]), (c_double * 3)()
        down[:] = [-c for c in nearest.direction]
        met = Object()
        away_m = tellus.tellus_objects_raycast(objects, above_m, down, 3.0 * nearest.size_m, None, byref(met))
        check(not math.isnan(away_m))
        is_hit = math.isfinite(away_m)
        hidden = tellus.tellus_objects_hide(objects, byref(met), 1) if is_hit else 0
        print(f"{'hit' if is_hit else 'nothing'} after {away_m if is_hit else 0.0:.3f}, hidden {hidden}")
    print(f"hidden {tellus.tellus_objects_hidden(objects, None, 0)}")
    tellus.tellus_objects_free(objects)


main()
