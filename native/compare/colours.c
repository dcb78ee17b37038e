/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* One scale of colours for deviations, wherever they are shown. */
#include "base/status.h"
#include "swarf/compare.h"

#include <math.h>

/* From -4 to +4 tolerances; the middle two bound what is well. Distinct in lightness too, for prints in grey and for
 * eyes that tell red from green badly. */
static const struct {
    double at;
    double rgb[3];
} stops[] = {{-4, {0.16, 0.18, 0.62}},     {-2, {0.16, 0.45, 0.86}},    {-1, {0.42, 0.80, 0.93}},
             {-0.999, {0.68, 0.86, 0.62}}, {0.999, {0.68, 0.86, 0.62}}, {1, {0.99, 0.87, 0.40}},
             {2, {0.96, 0.52, 0.16}},      {4, {0.72, 0.07, 0.12}}};

swarf_status swarf_deviation_colours(const double *value, size_t count, double tolerance, uint8_t *rgba)
{
    SWARF_REQUIRE((value && rgba) || count == 0, "colours: values or pixels missing");
    SWARF_REQUIRE(isfinite(tolerance) && tolerance > 0, "colours: a tolerance of %g mm", tolerance);
    enum { STOPS = sizeof stops / sizeof stops[0] };
    for (size_t i = 0; i < count; i++) {
        const double at = fmin(fmax(value[i] / tolerance, stops[0].at), stops[STOPS - 1].at);
        if (isnan(value[i])) continue;
        int upper = 1;
        while (upper < STOPS - 1 && at > stops[upper].at) upper++;
        const double part = (at - stops[upper - 1].at) / (stops[upper].at - stops[upper - 1].at);
        const double light = (0.2126 * rgba[4 * i] + 0.7152 * rgba[4 * i + 1] + 0.0722 * rgba[4 * i + 2]) / 255;
        for (int k = 0; k < 3; k++) {
            const double tint = stops[upper - 1].rgb[k] + part * (stops[upper].rgb[k] - stops[upper - 1].rgb[k]);
            /* the brightest pixels keep their tint, so that the colour stays one that the legend shows */
            rgba[4 * i + (size_t)k] = (uint8_t)(255 * tint * (0.3 + 0.7 * light) + 0.5);
        }
    }
    return SWARF_OK;
}
