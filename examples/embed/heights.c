/* Prints the ground under some places, and the extent of a tile. Build the library first (docs/embedding.md), then:
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

    free(indices);
    free(positions_m);
    tellus_planet_free(planet);
    return 0;
}
