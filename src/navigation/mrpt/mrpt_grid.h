#pragma once
/// Conversions between Grid and the maps of MRPT; sources of this folder alone include it.

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include "navigation/grid.h"

namespace robot_control::navigation {

/// Moves the grid by up to half a cell, so that it begins at a multiple of its resolution, as each grid of MRPT does.
/// Returns where the frame of the moved grid lies in that of the given one.
PlanarPose align(Grid& grid);

/// The grid is aligned.
mrpt::maps::COccupancyGridMap2D mrpt_grid(const Grid& grid);

/// Returns the middles of all occupied cells.
mrpt::maps::CSimplePointsMap wall_points(const Grid& grid);

}  // namespace robot_control::navigation
