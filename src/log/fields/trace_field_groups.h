#pragma once
/// The fields of Trace form groups; each function appends those of one group.

#include "log/fields/trace_fields.h"

namespace robot_control {

void add_sensors(TraceFields& to);
void add_links(TraceFields& to);
void add_timing(TraceFields& to);
void add_truth(TraceFields& to);
void add_estimate(TraceFields& to);
void add_trust(TraceFields& to);
void add_command(TraceFields& to);
void add_permit(TraceFields& to);
void add_driver(TraceFields& to);
void add_calls(TraceFields& to);
void add_tuning(TraceFields& to);
void add_frame_only_gate(TraceFields& to);
void add_frame_only_estimate(TraceFields& to);
void add_frame_only_command(TraceFields& to);

}  // namespace robot_control
