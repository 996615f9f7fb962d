#pragma once
/// A LocalController chooses the velocity of the next moment by model predictive path integral control: G. Williams,
/// P. Drews, B. Goldfain, J. Rehg and E. Theodorou, Information-theoretic model predictive control, IEEE Transactions
/// on Robotics 34 (2018), doi:10.1109/TRO.2018.2865891.
///
/// kSamples sequences of requested velocities are rolled out over kSteps·kRolloutStep, from the measured motion and
/// within the drive's accelerations. They are the last result, standing, noise about the last result, constant arcs,
/// and turns on the spot that are followed by a straight motion. A sequence costs, in m,
///
///   J = f(end) + f(ahead of the end) + kAlong·Σ f + kNearness·∫ near ds + kReverse·∫ reverse ds + Σ contacts
///
/// where f is the cost-to-go (planner.h), and `ahead` lies kAhead in front of the base: a robot that turns towards the
/// goal comes nearer. `near` rises to 1 at the margin of the outline. A contact is a pose whose outline is within
/// kMargin of an occupied cell, or within the margin of a moving object. A pose that is reached backwards over a cell
/// that neither the map nor a ray knows also counts. Moving objects go on with their velocities, and their margins grow
/// with time. The result is the mean of the sequences with the weights exp(−J/λ).
///
/// The noise may exceed the limits, within which a rollout keeps: else the mean would be slower than they allow.
///
/// The same inputs since the last reset give the same bits.

#include <array>
#include <random>
#include <vector>

#include "navigation/goals/planner.h"
#include "navigation/moving_objects.h"

namespace robot_control::navigation {

/// The drive's limits, within those of follow_path.
struct DriveLimits {
  double forward = 0.5;                   ///< m/s
  double reverse = 0.3;                   ///< m/s
  double angular = 1.0;                   ///< rad/s
  double lateral = 0;                     ///< m/s; 0 on wheels
  double linear_acceleration = 1.0;       ///< m/s²
  double angular_acceleration = 4.0;      ///< rad/s²
  double centripetal_acceleration = 0.3;  ///< m/s², on a curve; both speeds are reduced
};

class LocalController {
 public:
  explicit LocalController(const Footprint& footprint);

  /// Forgets the last result.
  void reset();

  /// Returns the velocity to be requested now. It is called every kRolloutStep. The costmap is up to date; `pose`,
  /// `to_goal` and `objects` are in its frame.
  PlanarMotion step(const DriveLimits& limits, const Costmap& costmap, const CostsToGoal& to_goal,
                    const PlanarPose& pose, const PlanarMotion& measured, const std::vector<MovingObject>& objects);

 private:
  static constexpr int kSamples = 256, kSteps = 32;
  using Sequence = std::array<PlanarMotion, kSteps>;

  struct Disc {  // a moving object
    Point at, velocity;
    double radius = 0;
  };
  struct Scene {
    const DriveLimits& limits;
    const Costmap& costmap;
    const CostsToGoal& to_goal;
    PlanarPose pose;
    PlanarMotion measured;
    std::vector<Disc> discs;
  };

  void draw(const DriveLimits& limits, int iteration);
  double cost(const Scene& scene, const Sequence& sequence) const;
  double air(const Costmap& costmap, const PlanarPose& pose) const;

  Footprint footprint_;
  std::vector<Point> border_;  // of the outline, every kSpacing
  std::mt19937 random_;
  Sequence mean_{};
  std::vector<Sequence> samples_ = std::vector<Sequence>(kSamples);
};

}  // namespace robot_control::navigation
