#pragma once

#include "fem/problem/ring_structure.h"
#include "fem/problem/structures/clamped.h"
#include "fem/problem/structures/end_face_held.h"
#include "fem/problem/structures/flange_held.h"
#include "fem/problem/structures/pin_held.h"
#include "fem/problem/structures/spline_held.h"
