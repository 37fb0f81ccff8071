#include "reference/energy/solve.hpp"
