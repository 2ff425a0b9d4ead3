#pragma once

// What nearly every file reads, parsed once for a whole build (pip install .). Never included: each
// file names what it needs, which the presets' builds show (CMakePresets.json; they have no such
// header, as a change of any file here builds all anew).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mpm/run/simulation.hpp"
