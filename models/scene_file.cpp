#include "models/scene_file.hpp"
