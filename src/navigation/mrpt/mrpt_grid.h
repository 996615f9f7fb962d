#pragma once
/// Conversions between Grid and the maps of MRPT; sources of this folder alone include it.

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include "navigation/grid.h"

namespace robot_control {

mrpt::maps::COccupancyGridMap2D mrpt_grid(const Grid& grid);

/// Cells with the probability one half are unknown.
Grid grid_of(const mrpt::maps::COccupancyGridMap2D& map);

/// Returns the middles of all occupied cells.
mrpt::maps::CSimplePointsMap wall_points(const Grid& grid);

}  // namespace robot_control
