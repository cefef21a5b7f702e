#pragma once
#include "openmvg_engines.h"
