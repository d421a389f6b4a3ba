/* Tellus: planets from one small file. Made from src/capi; docs/embedding.md tells more. */

#ifndef TELLUS_H
#define TELLUS_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/**
 * Most vertices along the side of a tile.
 */
#define TELLUS_MAX_TILE_SIDE 4097

/**
 * Most cells along a side of a chunk.
 */
#define TELLUS_MAX_CHUNK_CELLS 1024

/**
 * Solid objects near those who move: trunks, stones and others of populations that are solid. It keeps what was asked
 * for, so one thread uses it at a time. It may outlive its planet.
 */
typedef struct TellusObjects TellusObjects;

/**
 * A planet, ready for queries. Any number of threads may ask at once.
 */
typedef struct TellusPlanet TellusPlanet;

/**
 * The surface under one direction.
 */
typedef struct TellusSample {
  /**
   * Height of the ground above the reference sphere, below the sea too.
   */
  double height_m;
  /**
   * Surface of the sea, lake or river over the ground; NaN where there is none.
   */
  double water_level_m;
  /**
   * Unit normal of the ground in the planet frame.
   */
  double normal[3];
  /**
   * Angle between the ground and the horizontal.
   */
  double slope_rad;
  /**
   * Temperature at the surface.
   */
  double temperature_c;
  /**
   * Rain and snow in a year.
   */
  double rain_mm;
  /**
   * Index of the biome; see `tellus_biome_name`.
   */
  uint32_t biome;
} TellusSample;

/**
 * How much of the sky clouds cover, each 0 to 1.
 */
typedef struct TellusClouds {
  /**
   * Low clouds.
   */
  double low;
  /**
   * Middle clouds.
   */
  double middle;
  /**
   * The veil of high clouds.
   */
  double veil;
  /**
   * Fog: a share of the ground.
   */
  double fog;
} TellusClouds;

/**
 * Where a capsule that moves touches the ground.
 */
typedef struct TellusContact {
  /**
   * Share of the motion until it touches, 0 to 1.
   */
  double share;
  /**
   * Distance between the surfaces there; negative: how far the capsule must move along the normal to be free.
   */
  double gap_m;
  /**
   * The point of the ground in the planet frame, metres from the centre.
   */
  double point_m[3];
  /**
   * Unit vector from the ground to the capsule.
   */
  double normal[3];
} TellusContact;

/**
 * An object that stands on the ground: a plant, a stone, the same wherever and whenever it is asked for.
 */
typedef struct TellusInstance {
  /**
   * Its id in the population.
   */
  uint64_t id;
  /**
   * Seed of its population. With the id it names the object, whatever becomes of other populations.
   */
  uint32_t seed;
  /**
   * Index of its population; see `tellus_population_name`.
   */
  uint32_t population;
  /**
   * Unit direction of its place in the planet frame.
   */
  double direction[3];
  /**
   * Height of the ground there above the reference sphere.
   */
  double ground_m;
  /**
   * Height of its foot above the reference sphere: it may be sunk into the ground.
   */
  double base_m;
  /**
   * Unit vector from its foot to its top in the planet frame.
   */
  double axis[3];
  /**
   * Turn about the axis, against the clock as seen from the top.
   */
  double turn_rad;
  /**
   * Height along its axis.
   */
  double size_m;
  /**
   * Factor on the colours of its population.
   */
  double brightness;
  /**
   * Variant of the form, 0 to 3.
   */
  uint32_t variant;
  /**
   * Always 0.
   */
  uint32_t reserved;
} TellusInstance;

/**
 * The name of an object among all of a planet. A save may hold its bytes: they are the same on every machine of one
 * byte order.
 */
typedef struct TellusObject {
  /**
   * Its id in the population.
   */
  uint64_t id;
  /**
   * Seed of its population.
   */
  uint32_t seed;
  /**
   * Write 0.
   */
  uint32_t reserved;
} TellusObject;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of the library.
 */
const char *tellus_version(void);

/**
 * What went wrong in the last call that failed on this thread; empty if none did. Valid until the next call that fails
 * on this thread.
 */
const char *tellus_last_error(void);

/**
 * Loads a preset from a file, with its height maps. NULL if that failed.
 *
 * A planet with a structure solves its maps first, which takes a second or more. They are kept in `cache_folder` for
 * the next time, at most 1 GiB of them; NULL keeps none.
 *
 * # Safety
 * `path` and `cache_folder` are NULL or end with a zero byte.
 */
struct TellusPlanet *tellus_planet_from_file(const char *path,
                                             const char *cache_folder);

/**
 * Loads a preset from text. Height maps must have absolute paths. `name` stands for the file in messages. NULL if that
 * failed. See `tellus_planet_from_file` for `cache_folder`.
 *
 * # Safety
 * `name`, `preset` and `cache_folder` are NULL or end with a zero byte.
 */
struct TellusPlanet *tellus_planet_from_text(const char *name,
                                             const char *preset,
                                             const char *cache_folder);

/**
 * Frees a planet. NULL is ignored.
 *
 * # Safety
 * `planet` is NULL or came from this library, is not freed twice, and no thread uses it any more.
 */
void tellus_planet_free(struct TellusPlanet *planet);

/**
 * The name of the planet. Valid as long as the planet; NULL if `planet` is NULL.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
const char *tellus_name(const struct TellusPlanet *planet);

/**
 * A hash of all that the planet is, as 32 hexadecimal digits; the same on every machine. Valid as long as the planet.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
const char *tellus_hash(const struct TellusPlanet *planet);

/**
 * Radius of the reference sphere in metres; NaN if `planet` is NULL.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
double tellus_radius_m(const struct TellusPlanet *planet);

/**
 * Number of biomes.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
uint32_t tellus_biome_count(const struct TellusPlanet *planet);

/**
 * The name of a biome. Valid as long as the planet; NULL if there is no such biome.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
const char *tellus_biome_name(const struct TellusPlanet *planet, uint32_t biome);

/**
 * The unit direction of a place in the planet frame: Z points to the north pole, X to latitude 0 and longitude 0.
 * `lat_deg` is -90 to 90. False, and nothing written, if that failed.
 *
 * # Safety
 * `direction` is NULL or holds 3 numbers.
 */
bool tellus_direction(double lat_deg,
                      double lon_deg,
                      double *direction);

/**
 * Heights of the ground in metres under `count` directions of 3 numbers each, on the calling thread. False, and
 * nothing written, if that failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `heights_m` is
 * NULL or holds `count`.
 */
bool tellus_heights(const struct TellusPlanet *planet,
                    const double *directions,
                    size_t count,
                    double *heights_m);

/**
 * As `tellus_heights`, without rivers and valleys of a structure that points `spacing_m` metres apart would not show:
 * far cheaper where points are spread over the planet. 0 is all of them.
 *
 * # Safety
 * As for `tellus_heights`.
 */
bool tellus_heights_spaced(const struct TellusPlanet *planet,
                           const double *directions,
                           size_t count,
                           double spacing_m,
                           double *heights_m);

/**
 * The surface under `count` directions of 3 numbers each, on the calling thread. False, and nothing written, if that
 * failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `samples` is NULL
 * or holds `count`.
 */
bool tellus_samples(const struct TellusPlanet *planet,
                    const double *directions,
                    size_t count,
                    struct TellusSample *samples);

/**
 * As `tellus_samples`, without rivers and valleys of a structure that points `spacing_m` metres apart would not show.
 * 0 is all of them.
 *
 * # Safety
 * As for `tellus_samples`.
 */
bool tellus_samples_spaced(const struct TellusPlanet *planet,
                           const double *directions,
                           size_t count,
                           double spacing_m,
                           struct TellusSample *samples);

/**
 * Distance in metres along a ray (planet frame, metres from the centre) to the ground or the sea, whichever is nearer:
 * infinite if it meets neither, NaN if that failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `origin_m` and `direction` are NULL or hold 3 numbers.
 */
double tellus_raycast(const struct TellusPlanet *planet,
                      const double *origin_m,
                      const double *direction);

/**
 * The vertices of a square of the globe, `side` by `side`: positions in the planet frame (metres from the centre) and
 * unit normals, 3 numbers each, column by column within rows. Neighbours of one level share their edges to the bit.
 *
 * `face` is 0 to 5: +X, -X, +Y, -Y, +Z, -Z. A face has `2^level` by `2^level` squares, `level` 0 to 22. `normals` may
 * be NULL. False, and nothing written, if that failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `positions_m` and `normals` are NULL or hold 3 `side` `side` numbers.
 */
bool tellus_tile(const struct TellusPlanet *planet,
                 uint32_t face,
                 uint32_t level,
                 uint32_t x,
                 uint32_t y,
                 uint32_t side,
                 double *positions_m,
                 float *normals);

/**
 * The triangles of a tile of `side` by `side` vertices: 6 (`side` - 1)^2 indices, counter-clockwise from outside.
 * False, and nothing written, if that failed.
 *
 * # Safety
 * `indices` is NULL or holds 6 (`side` - 1)^2 numbers.
 */
bool tellus_tile_indices(uint32_t side,
                         uint32_t *indices);

/**
 * Clouds over `count` directions of 3 numbers each at a time in seconds; 0 on a planet without clouds. False, and
 * nothing written, if that failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `clouds` is NULL
 * or holds `count`.
 */
bool tellus_clouds(const struct TellusPlanet *planet,
                   const double *directions,
                   size_t count,
                   double time_s,
                   struct TellusClouds *clouds);

/**
 * Heights of the water's surface over the reference sphere in metres under `count` directions of 3 numbers each at a
 * time in seconds: of the sea with its waves, of lakes and rivers their level; NaN on land. Directions should lie
 * within some kilometres of each other: all have the waves around the first. False, and nothing written, if that
 * failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `heights_m` is
 * NULL or holds `count`.
 */
bool tellus_water(const struct TellusPlanet *planet,
                  const double *directions,
                  size_t count,
                  double time_s,
                  double *heights_m);

/**
 * A square of ground for a physics engine, in a local frame: metres along east, north and up of a place, from the
 * ground there. `column` counts to the east, `row` to the north; the place is the south west corner of 0, 0.
 * Neighbours share the vertices of their border to the bit.
 *
 * `positions_m` and `normals` have 3 (`cells` + 1)^2 numbers, row by row from the south west; `normals` may be NULL.
 * The triangles are those of `tellus_tile_indices` with a side of `cells` + 1. False, and nothing written, if that
 * failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `direction` is NULL or holds 3 numbers, and `positions_m` and
 * `normals` are NULL or hold 3 (`cells` + 1)^2.
 */
bool tellus_chunk(const struct TellusPlanet *planet,
                  const double *direction,
                  double side_m,
                  uint32_t cells,
                  int32_t column,
                  int32_t row,
                  float *positions_m,
                  float *normals);

/**
 * How far a capsule moves until it is `skin_m` from the ground: all points within `radius_m` of the line between two
 * ends (3 numbers each, planet frame, metres from the centre; a ball has both in one place). `motion_m` has 3 numbers.
 * What touches may leave. 1 and `contact` written if it is stopped, 0 if it is not, -1 if that failed. The sea does
 * not count.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `ends_m` is NULL or holds 6 numbers, `motion_m` is NULL or holds 3,
 * and `contact` is NULL or holds one.
 */
int32_t tellus_sweep(const struct TellusPlanet *planet,
                     const double *ends_m,
                     double radius_m,
                     const double *motion_m,
                     double skin_m,
                     struct TellusContact *contact);

/**
 * Number of populations.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
uint32_t tellus_population_count(const struct TellusPlanet *planet);

/**
 * The name of a population. Valid as long as the planet; NULL if there is no such population.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
const char *tellus_population_name(const struct TellusPlanet *planet, uint32_t population);

/**
 * The objects within `radius_m` of a direction of 3 numbers, along the reference sphere, on all cores. The answer is
 * their number, -1 if that failed. The first `capacity` of them are written, in ascending order of their ids: if there
 * are more, ask with a larger buffer. `instances` may be NULL where `capacity` is 0.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `direction` is NULL or holds 3 numbers, and `instances` is NULL or
 * holds `capacity`.
 */
int64_t tellus_instances(const struct TellusPlanet *planet,
                         const double *direction,
                         double radius_m,
                         struct TellusInstance *instances,
                         size_t capacity);

/**
 * The nearest object to a direction of 3 numbers within a distance along the reference sphere, of one population or,
 * where `population` is negative, of any. 1 and `instance` written, 0 if there is none, -1 if that failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library; `direction` is NULL or holds 3 numbers, and `instance` is NULL or
 * holds one.
 */
int32_t tellus_nearest_object(const struct TellusPlanet *planet,
                              const double *direction,
                              double within_m,
                              int32_t population,
                              struct TellusInstance *instance);

/**
 * The solid objects of a planet. The forms of its populations are measured first, which takes some milliseconds for
 * each. NULL if that failed.
 *
 * # Safety
 * `planet` is NULL or a planet of this library.
 */
struct TellusObjects *tellus_objects(const struct TellusPlanet *planet);

/**
 * Frees solid objects. NULL is ignored.
 *
 * # Safety
 * `objects` is NULL or came from this library, is not freed twice, and no thread uses it any more.
 */
void tellus_objects_free(struct TellusObjects *objects);

/**
 * Where a capsule (as that of `tellus_sweep`) is nearest to an object. 1 and `contact` written, with a share of 0, if
 * one is within `within_m`, 0 if none is, -1 if that failed. `object` may be NULL.
 *
 * # Safety
 * `objects` is NULL or came from `tellus_objects`, and no other thread uses it; `ends_m` is NULL or holds 6 numbers,
 * `contact` and `object` are NULL or hold one.
 */
int32_t tellus_objects_contact(struct TellusObjects *objects,
                               const double *ends_m,
                               double radius_m,
                               double within_m,
                               struct TellusContact *contact,
                               struct TellusObject *object);

/**
 * As `tellus_sweep`, among objects alone: the ground does not stop the motion. `object` may be NULL.
 *
 * # Safety
 * As for `tellus_objects_contact`; `motion_m` is NULL or holds 3 numbers.
 */
int32_t tellus_objects_sweep(struct TellusObjects *objects,
                             const double *ends_m,
                             double radius_m,
                             const double *motion_m,
                             double skin_m,
                             struct TellusContact *contact,
                             struct TellusObject *object);

/**
 * Distance in metres along a ray (planet frame, metres from the centre) to the first object, up to `to_m`: infinite if
 * it meets none, NaN if that failed. Neither the ground nor the sea stops it; see `tellus_raycast`. `normal` has 3
 * numbers; it and `object` may be NULL, and are written where an object is met.
 *
 * # Safety
 * `objects` is NULL or came from `tellus_objects`, and no other thread uses it; `origin_m`, `direction` and `normal`
 * are NULL or hold 3 numbers, `object` is NULL or holds one.
 */
double tellus_objects_raycast(struct TellusObjects *objects,
                              const double *origin_m,
                              const double *direction,
                              double to_m,
                              double *normal,
                              struct TellusObject *object);

/**
 * Hides `count` objects, those that a game has felled or taken: nothing hits them. The answer is how many were there
 * before, -1 if that failed. Objects of populations that the planet does not have may be among them.
 *
 * # Safety
 * `objects` is NULL or came from `tellus_objects`, and no other thread uses it; `hidden` is NULL or holds `count`.
 */
int64_t tellus_objects_hide(struct TellusObjects *objects,
                            const struct TellusObject *hidden,
                            size_t count);

/**
 * Shows `count` objects again. The answer is how many were hidden, -1 if that failed.
 *
 * # Safety
 * As for `tellus_objects_hide`.
 */
int64_t tellus_objects_show(struct TellusObjects *objects,
                            const struct TellusObject *shown,
                            size_t count);

/**
 * The hidden objects, for a save. The answer is their number, -1 if that failed. The first `capacity` of them are
 * written, in ascending order of seeds and ids. `hidden` may be NULL where `capacity` is 0.
 *
 * # Safety
 * As for `tellus_objects_hide`; `hidden` is NULL or holds `capacity`.
 */
int64_t tellus_objects_hidden(const struct TellusObjects *objects,
                              struct TellusObject *hidden,
                              size_t capacity);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TELLUS_H */
