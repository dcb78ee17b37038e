/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutters: a body of revolution about +z, tip at z = 0, made of parts that each cut or must not touch.
 *
 * A part is the chain of its meridian in the half plane (r, z), r >= 0, from the axis at its lowest
 * height up and back to the axis: nodes with a bulge each, the bulge being tan(angle / 4) of the arc
 * from this node to the next (0: a straight line; positive: the arc turns counter-clockwise, i.e. it
 * bulges away from the axis when walking upwards). A part has one radius at each height: undercuts
 * are fine, hollows are not. Lengths in mm.
 */
#ifndef SWARF_CUTTER_H
#define SWARF_CUTTER_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Immutable; shared by reference count; any thread. */
typedef struct swarf_cutter swarf_cutter;

/** What a part does. */
typedef enum swarf_part_kind {
    SWARF_PART_FLUTES = 0, /**< removes stock */
    SWARF_PART_SHANK = 1,  /**< must touch nothing */
    SWARF_PART_HOLDER = 2  /**< must touch nothing */
} swarf_part_kind;

/** A node of a meridian; see the head of this file. */
typedef struct swarf_profile_node {
    double r;
    double z;
    double bulge;
} swarf_profile_node;

/** A part as the caller describes it; the nodes are copied. */
typedef struct swarf_cutter_part {
    swarf_part_kind kind;
    const swarf_profile_node *nodes;
    size_t node_count;
} swarf_cutter_part;

/** The common shapes. Letters in brackets: the dimensions each takes, [optional]. */
typedef enum swarf_shape {
    SWARF_SHAPE_FLAT = 0,     /**< end mill: d l */
    SWARF_SHAPE_BALL,         /**< ball end: d l */
    SWARF_SHAPE_BULL,         /**< bull-nose: d l r */
    SWARF_SHAPE_CHAMFER,      /**< chamfer / V-bit: d l a [t] */
    SWARF_SHAPE_DRILL,        /**< twist drill: d l [a = 118] */
    SWARF_SHAPE_TAPERED_BALL, /**< tapered ball: t (ball diameter) a (angle per side) l [d] */
    SWARF_SHAPE_LOLLIPOP,     /**< ball on a neck: d n l */
    SWARF_SHAPE_TSLOT,        /**< T-slot cutter or slitting saw: d n h l [r] */
    SWARF_SHAPE_DOVETAIL,     /**< dovetail, widest at the tip: d a h n l */
    SWARF_SHAPE_THREAD_MILL,  /**< thread mill: d p [k = 1 teeth] n l [a = 60] */
    SWARF_SHAPE_FORM,         /**< any profile: nodes r/z[/bulge] separated by ':' */
    SWARF_SHAPE_COUNT
} swarf_shape;

/** Dimensions of a common shape, mm and degrees; NAN means "not given". */
typedef struct swarf_dimensions {
    size_t size;            /**< sizeof(swarf_dimensions), set by swarf_dimensions_default() */
    double diameter;        /**< d: greatest cutting diameter */
    double length;          /**< l: from the tip to the end of the cutting part (or of the neck) */
    double corner_radius;   /**< r */
    double tip_diameter;    /**< t: flat at the tip, or ball at the tip of a tapered ball */
    double angle_deg;       /**< a: chamfer and drill: included angle of the point; tapered ball: per side;
                                 dovetail: between the flank and the bottom plane; thread: flank angle */
    double neck_diameter;   /**< n: of the reduced neck above the cutting edge */
    double edge_height;     /**< h: height of the cutting edge (T-slot, dovetail) */
    double pitch;           /**< p: thread mill */
    double teeth;           /**< k: thread mill, rows of teeth along the axis */
    double shank_diameter;  /**< sd: adds a cylindrical shank above the flutes */
    double shank_length;    /**< sl: its length */
    double holder_diameter; /**< hd: adds a cylindrical holder above the shank */
    double holder_length;   /**< hl: its length */
} swarf_dimensions;

/** All dimensions "not given". Any thread. */
SWARF_API swarf_dimensions swarf_dimensions_default(void);

/** A cutter from parts in any order; the flutes may be missing (then it cuts nothing).
 *  SWARF_ERROR_ARGUMENT: NULL, no parts, numbers not finite. SWARF_ERROR_GEOMETRY: a meridian that
 *  is empty, crosses itself, leaves r >= 0 or has two radii at one height. The caller owns one reference. */
SWARF_API swarf_status swarf_cutter_create(const swarf_cutter_part *parts, size_t part_count, swarf_cutter **out);

/** A cutter of a common shape (not SWARF_SHAPE_FORM). SWARF_ERROR_ARGUMENT names the dimension that is
 *  missing or impossible. The caller owns one reference. */
SWARF_API swarf_status swarf_cutter_create_shape(swarf_shape shape, const swarf_dimensions *dimensions,
                                                 swarf_cutter **out);

/** A cutter from text, e.g. "flat:d=3,l=18", "bull:d=6,r=1,l=20,sd=6,sl=30",
 *  "form:0/0:3/0:3/4:2/5/0.41:0/5". SWARF_ERROR_FORMAT names the word and what would be right. */
SWARF_API swarf_status swarf_cutter_parse(const char *text, swarf_cutter **out);

SWARF_API swarf_cutter *swarf_cutter_retain(swarf_cutter *cutter);
/** Give one reference back; NULL is legal. */
SWARF_API void swarf_cutter_release(swarf_cutter *cutter);

SWARF_API size_t swarf_cutter_part_count(const swarf_cutter *cutter);
/** View of part `index`, owned by the cutter; SWARF_ERROR_ARGUMENT if out of range. */
SWARF_API swarf_status swarf_cutter_part_get(const swarf_cutter *cutter, size_t index, swarf_cutter_part *out);

/** Greatest radius of the parts of one kind, 0 if it has none. */
SWARF_API double swarf_cutter_radius(const swarf_cutter *cutter, swarf_part_kind kind);
/** Lowest and highest z of the parts of one kind; both 0 if it has none. */
SWARF_API void swarf_cutter_extent(const swarf_cutter *cutter, swarf_part_kind kind, double *z_lo, double *z_hi);
/** Radius of the parts of one kind at height z (the greatest, where the profile is horizontal); -1 outside. */
SWARF_API double swarf_cutter_radius_at(const swarf_cutter *cutter, swarf_part_kind kind, double z);
/** Volume of the parts of one kind in mm3, exact (Pappus). */
SWARF_API double swarf_cutter_volume(const swarf_cutter *cutter, swarf_part_kind kind);

#ifdef __cplusplus
}
#endif
#endif
