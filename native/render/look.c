/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sections make the scene the part of space before all planes: a ray has one stretch in it. Where that begins within
 * the stock its cut face is seen. The cutter is whole in any section. */
#include "render/look.h"

#include "base/status.h"
#include "base/vector.h"
#include "render/embree_fixtures.h"

#include <string.h>

static void unite(swarf_box *box, const swarf_box *other)
{
    for (int axis = 0; axis < 3; axis++) {
        box->lo[axis] = fmin(box->lo[axis], other->lo[axis]);
        box->hi[axis] = fmax(box->hi[axis], other->hi[axis]);
    }
}

/** The box of all that rays meet. */
static void measure(const swarf_look *look, swarf_box *out)
{
    const swarf_fixtures *fixtures = swarf_scene_fixtures(look->scene);
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}, part;
    swarf_scene_box(look->scene, &part);
    if (part.lo[0] <= part.hi[0]) unite(&box, &part);
    if (fixtures) {
        swarf_fixtures_box(fixtures, &part);
        unite(&box, &part);
    }
    if (look->cutter) {
        swarf_revolve_box(look->cutter, &part);
        unite(&box, &part);
    }
    for (int axis = 0; axis < 3; axis++)
        if (!(box.lo[axis] <= box.hi[axis])) box.lo[axis] = box.hi[axis] = 0;
    *out = box;
}

static swarf_status take_sections(const swarf_picture_options *options, swarf_look *look)
{
    SWARF_REQUIRE(options->section_count <= SWARF_SECTIONS_MAX, "picture: %zu sections, more than %d",
                  options->section_count, SWARF_SECTIONS_MAX);
    SWARF_REQUIRE(options->section || options->section_count == 0, "picture: sections missing");
    for (size_t i = 0; i < options->section_count; i++) {
        look->section[i] = options->section[i];
        for (int axis = 0; axis < 3; axis++)
            SWARF_REQUIRE(isfinite(options->section[i].point[axis]) && isfinite(options->section[i].normal[axis]),
                          "picture: a number of section %zu is not finite", i);
        SWARF_REQUIRE(vector_normalise(look->section[i].normal) > 0, "picture: the normal of section %zu is zero", i);
    }
    look->section_count = options->section_count;
    return SWARF_OK;
}

static swarf_status take_cutter(const swarf_picture_options *options, swarf_look *look)
{
    if (!options->cutter) return SWARF_OK;
    for (int axis = 0; axis < 3; axis++)
        SWARF_REQUIRE(isfinite(options->cutter_tip[axis]), "picture: %c of the cutter's tip is not finite",
                      "xyz"[axis]);
    return swarf_revolve_create(options->cutter, options->cutter_tip, &look->cutter);
}

static void take_frame(swarf_look *look, int32_t rows)
{
    swarf_box box;
    double square = 0;
    look->source.parallel = !look->frame.perspective;
    measure(look, &box);
    for (int axis = 0; axis < 3; axis++) {
        look->source.eye[axis] = look->frame.eye[axis];
        look->source.forward[axis] = look->frame.forward[axis];
        look->source.right[axis] = look->frame.half[0] * look->frame.right[axis];
        look->source.up[axis] = look->frame.half[1] * look->frame.up[axis];
        look->middle[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
        square += (box.hi[axis] - box.lo[axis]) * (box.hi[axis] - box.lo[axis]);
    }
    look->size = sqrt(square);
    look->pixel = 2 * look->frame.half[1] / rows;
    for (int corner = 0; look->source.parallel && corner < 8; corner++) {
        double behind = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double at = corner >> axis & 1 ? box.hi[axis] : box.lo[axis];
            behind -= (at - look->frame.eye[axis]) * look->frame.forward[axis];
        }
        /* Parallel rays start behind everything. One millimetre: clear of what lies right at the box's corner. */
        look->source.back = fmax(look->source.back, behind + 1);
    }
}

swarf_status swarf_look_begin(const swarf_scene *scene, const swarf_camera *camera,
                              const swarf_picture_options *options, int32_t rows, swarf_look *out)
{
    swarf_look look = {.scene = scene};
    SWARF_TRY(swarf_camera_frame_make(camera, (double)options->width / options->height, &look.frame));
    SWARF_TRY(take_sections(options, &look));
    SWARF_TRY(take_cutter(options, &look));
    take_frame(&look, rows);
    *out = look;
    return SWARF_OK;
}

void swarf_look_end(swarf_look *look)
{
    swarf_revolve_destroy(look->cutter);
    look->cutter = NULL;
}

void swarf_look_ray(const swarf_look *look, const double place[2], double origin[3], double direction[3])
{
    swarf_camera_frame_ray(&look->frame, place[0], place[1], origin, direction);
    (void)vector_normalise(direction);
    for (int axis = 0; axis < 3; axis++) origin[axis] -= look->source.back * direction[axis];
}

double swarf_look_footprint(const swarf_look *look, const swarf_sight *sight)
{
    return look->frame.perspective ? look->pixel * sight->distance : look->pixel;
}

/** Move the rays to where they come before all sections, skipped[i] mm on, and end them where they leave; `through`:
 *  the number of the plane that they come in by, -1: none. */
static void cut(const swarf_look *look, swarf_rays *rays, double skipped[SWARF_PACKET], int through[SWARF_PACKET])
{
    for (int i = 0; i < SWARF_PACKET; i++) {
        double enter = 0, leave = rays->reach[i];
        through[i] = -1;
        for (size_t plane = 0; plane < look->section_count; plane++) {
            const swarf_cut_plane *s = &look->section[plane];
            double height = 0, slope = 0;
            for (int axis = 0; axis < 3; axis++) {
                height += (rays->origin[axis][i] - s->point[axis]) * s->normal[axis];
                slope += rays->direction[axis][i] * s->normal[axis];
            }
            const double t = -height / slope;
            if (slope < 0 && t > enter) {
                enter = t;
                through[i] = (int)plane;
            } else if (slope > 0) {
                leave = fmin(leave, t);
            } else if (slope == 0 && height > 0) {
                leave = -1;
            }
        }
        if (!(enter < leave)) rays->active &= ~(1u << i);
        skipped[i] = enter;
        rays->reach[i] = leave - enter;
        for (int axis = 0; axis < 3; axis++) rays->origin[axis][i] += enter * rays->direction[axis][i];
    }
}

static void see_cutter(const swarf_look *look, const swarf_rays *rays, const double skipped[SWARF_PACKET],
                       unsigned count, swarf_sight out[])
{
    static const swarf_seen seen[] = {
        [SWARF_PART_FLUTES] = SWARF_SEEN_FLUTES,
        [SWARF_PART_SHANK] = SWARF_SEEN_SHANK,
        [SWARF_PART_HOLDER] = SWARF_SEEN_HOLDER,
    };
    for (unsigned ray = 0; ray < count; ray++) {
        double origin[3], direction[3];
        swarf_part_kind kind;
        for (int axis = 0; axis < 3; axis++) {
            direction[axis] = rays->direction[axis][ray];
            origin[axis] = rays->origin[axis][ray] - skipped[ray] * direction[axis];
        }
        if (swarf_revolve_trace(look->cutter, origin, direction, out[ray].distance, &out[ray].distance, out[ray].normal,
                                &kind))
            out[ray].seen = seen[kind];
    }
}

/* What the rays of a packet have met becomes sights. */
static void tell(const swarf_look *look, const swarf_rays *rays, const double skipped[SWARF_PACKET],
                 const int through[SWARF_PACKET], unsigned inside, unsigned fixed, unsigned count, swarf_sight out[])
{
    for (unsigned ray = 0; ray < count; ray++) {
        swarf_sight *sight = &out[ray];
        const int hit = (int)((rays->hit | fixed) >> ray & 1);
        const int capped = look->section_count && (inside >> ray & 1) && through[ray] >= 0;
        sight->distance = capped ? skipped[ray] : skipped[ray] + rays->distance[ray];
        sight->move = -1;
        sight->seen = capped                 ? SWARF_SEEN_SECTION
                      : fixed >> ray & 1     ? SWARF_SEEN_FIXTURE
                      : rays->hit >> ray & 1 ? SWARF_SEEN_STOCK
                                             : SWARF_SEEN_NOTHING;
        for (int axis = 0; axis < 3; axis++) {
            sight->normal[axis] = hit ? rays->normal[axis][ray] : 0;
            if (capped) sight->normal[axis] = (float)look->section[through[ray]].normal[axis];
        }
    }
    if (look->cutter) see_cutter(look, rays, skipped, count, out);
    for (unsigned ray = 0; ray < count; ray++)
        for (int axis = 0; axis < 3; axis++) {
            const double way = out[ray].distance - skipped[ray], origin = rays->origin[axis][ray];
            const double at = origin + way * rays->direction[axis][ray] - look->middle[axis];
            out[ray].point[axis] = out[ray].seen == SWARF_SEEN_NOTHING ? 0 : (float)at;
        }
}

void swarf_look_through(const swarf_look *look, const swarf_places places[], int count, swarf_sight *const out[])
{
    swarf_rays rays[SWARF_GROUP];
    double skipped[SWARF_GROUP][SWARF_PACKET] = {{0}};
    int through[SWARF_GROUP][SWARF_PACKET] = {{0}};
    unsigned inside[SWARF_GROUP];
    const swarf_fixtures *fixtures = swarf_scene_fixtures(look->scene);
    for (int i = 0; i < count; i++) {
        swarf_ray_kernel_current()->aim(&look->source, places[i].x, places[i].y, &rays[i]);
        rays[i].active = (1u << places[i].count) - 1;
        if (look->section_count) cut(look, &rays[i], skipped[i], through[i]);
    }
    swarf_scene_trace(look->scene, rays, inside, count);
    for (int i = 0; i < count; i++) {
        const unsigned open = rays[i].active & ~inside[i];
        const unsigned fixed = fixtures && open ? swarf_fixtures_trace(fixtures, &rays[i], open) : 0;
        tell(look, &rays[i], skipped[i], through[i], inside[i], fixed, places[i].count, out[i]);
    }
}

void swarf_look_trace(const swarf_look *look, const swarf_places places[], int count, swarf_rays rays[])
{
    unsigned inside[SWARF_GROUP];
    for (int i = 0; i < count; i++) {
        swarf_ray_kernel_current()->aim(&look->source, places[i].x, places[i].y, &rays[i]);
        rays[i].active = (1u << places[i].count) - 1;
    }
    swarf_scene_trace(look->scene, rays, inside, count);
}

void swarf_look_blocked(const swarf_look *look, swarf_rays rays[], unsigned blocked[], unsigned inside[], int count)
{
    double skipped[SWARF_PACKET];
    int through[SWARF_PACKET] = {0};
    const swarf_fixtures *fixtures = swarf_scene_fixtures(look->scene);
    for (int i = 0; look->section_count && i < count; i++) cut(look, &rays[i], skipped, through);
    swarf_scene_trace(look->scene, rays, inside, count);
    for (int i = 0; i < count; i++) {
        blocked[i] = rays[i].hit;
        if (fixtures && rays[i].active) blocked[i] |= swarf_fixtures_trace(fixtures, &rays[i], rays[i].active);
    }
}
