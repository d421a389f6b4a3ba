/* Prints the ground under some places, the extent of a tile, clouds, water and a falling ball at a time, and objects.
   Build the library first (docs/embedding.md), then:
   cc -Iinclude examples/embed/heights.c -Ltarget/debug -ltellus -lm -o heights */

#include "tellus.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COUNT = 3, SIDE = 33 };

static void fail(void) {
    fprintf(stderr, "error: %s\n", tellus_last_error());
    exit(1);
}

int main(int argc, char **argv) {
    const char *path = argc > 1 ? argv[1] : "planets/pallor.ron";
    struct TellusPlanet *planet = tellus_planet_from_file(path, NULL);
    if (!planet) fail();
    printf("%s %s\n", tellus_name(planet), tellus_hash(planet));

    const double places[COUNT][2] = {{48.2, 16.4}, {-33.9, 151.2}, {0.0, -78.5}};
    double directions[COUNT][3];
    struct TellusSample samples[COUNT];
    for (int i = 0; i < COUNT; i++) tellus_direction(places[i][0], places[i][1], directions[i]);
    if (!tellus_samples(planet, directions[0], COUNT, samples)) fail();
    for (int i = 0; i < COUNT; i++) {
        printf("%.3f %s\n", samples[i].height_m, tellus_biome_name(planet, samples[i].biome));
    }

    /* One square of the globe, as a mesh. */
    double *positions_m = malloc(sizeof(double) * 3 * SIDE * SIDE);
    unsigned *indices = malloc(sizeof(unsigned) * 6 * (SIDE - 1) * (SIDE - 1));
    if (!positions_m || !indices) return 1;
    if (!tellus_tile(planet, 0, 4, 3, 5, SIDE, positions_m, NULL)) fail();
    if (!tellus_tile_indices(SIDE, indices)) fail();
    double least_m = INFINITY, greatest_m = -INFINITY;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double *p = positions_m + 3 * i;
        double height_m = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - tellus_radius_m(planet);
        least_m = fmin(least_m, height_m);
        greatest_m = fmax(greatest_m, height_m);
    }
    printf("tile %.3f %.3f\n", least_m, greatest_m);

    /* What a game asks at each moment: clouds, the height of the water with its waves, and where a ball that falls by
       two kilometres touches the ground. */
    const double time_s = 5000.0;
    struct TellusClouds clouds[COUNT];
    double water_m[COUNT];
    if (!tellus_clouds(planet, directions[0], COUNT, time_s, clouds)) fail();
    for (int i = 0; i < COUNT; i++) {
        if (!tellus_water(planet, directions[i], 1, time_s, &water_m[i])) fail();
        double ends_m[6], motion_m[3];
        for (int k = 0; k < 6; k++) {
            ends_m[k] = directions[i][k % 3] * (tellus_radius_m(planet) + samples[i].height_m + 1000.0);
        }
        for (int k = 0; k < 3; k++) motion_m[k] = directions[i][k] * -2000.0;
        struct TellusContact contact;
        int touches = tellus_sweep(planet, ends_m, 2.0, motion_m, 0.0, &contact);
        if (touches != 1) fail();
        printf("clouds %.4f %.4f %.4f, ", clouds[i].low, clouds[i].middle, clouds[i].veil);
        if (isnan(water_m[i])) printf("dry, ");
        else printf("water %.3f, ", water_m[i]);
        printf("falls by %.3f\n", contact.share * 2000.0);
    }

    /* Ground for a physics engine. */
    float chunk_m[9 * 9][3], normals[9 * 9][3];
    if (!tellus_chunk(planet, directions[0], 100.0, 8, -1, 2, chunk_m[0], normals[0])) fail();
    printf("chunk %.3f %.3f %.3f\n", chunk_m[80][0], chunk_m[80][1], chunk_m[80][2]);

    /* Plants and stones around the places. The nearest one of the first population is hit from above, and hidden. */
    struct TellusObjects *objects = tellus_objects(planet);
    if (!objects) fail();
    struct TellusInstance nearest, *around = malloc(sizeof *around * 50000);
    if (!around) return 1;
    for (int i = 0; i < COUNT; i++) {
        int64_t count = tellus_instances(planet, directions[i], 30.0, around, 50000);
        int there = tellus_nearest_object(planet, directions[i], 5000.0, 0, &nearest);
        if (count < 0 || there < 0) fail();
        printf("objects %lld\n", (long long)count);
        if (there == 0) continue;
        printf("nearest %s %llu %.3f\n", tellus_population_name(planet, nearest.population),
               (unsigned long long)nearest.id, nearest.size_m);
        double above_m[3], down[3];
        for (int k = 0; k < 3; k++) {
            above_m[k] = nearest.direction[k] * (tellus_radius_m(planet) + nearest.base_m + 2.0 * nearest.size_m);
            down[k] = -nearest.direction[k];
        }
        struct TellusObject object = {0};
        double away_m = tellus_objects_raycast(objects, above_m, down, 3.0 * nearest.size_m, NULL, &object);
        if (isnan(away_m)) fail();
        int64_t hidden = isinf(away_m) ? 0 : tellus_objects_hide(objects, &object, 1);
        printf("%s after %.3f, hidden %lld\n", isinf(away_m) ? "nothing" : "hit", isinf(away_m) ? 0.0 : away_m,
               (long long)hidden);
    }
    printf("hidden %lld\n", (long long)tellus_objects_hidden(objects, NULL, 0));
    tellus_objects_free(objects);
    free(around);

    free(indices);
    free(positions_m);
    tellus_planet_free(planet);
    return 0;
}
