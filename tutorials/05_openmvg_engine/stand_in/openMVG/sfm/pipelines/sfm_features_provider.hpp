#pragma once
#include "openmvg_types.h"
