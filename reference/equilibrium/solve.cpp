#include "reference/equilibrium/solve.hpp"
