/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Everything of libswarf. */
#ifndef SWARF_H
#define SWARF_H

#include "base.h"
#include "check.h"
#include "compare.h"
#include "cutter.h"
#include "gcode.h"
#include "history.h"
#include "load.h"
#include "lumps.h"
#include "mesh.h"
#include "place.h"
#include "placement.h"
#include "program.h"
#include "render.h"
#include "solid.h"
#include "stock.h"
#include "surface.h"
#include "sweep.h"

#endif
