#pragma once
/// Marks the forces of all contacts of a sensor frame as measured.

#include "signals/sensor_frame.h"

namespace robot_control {

inline void measure_contacts(SensorFrame& sensors) noexcept {
  sensors.contact_count = kMaxContacts;
  for (ContactSample& contact : sensors.contacts) contact.valid = 1;
}

}  // namespace robot_control
