#pragma once
/// The messages of ODrive CANSimple that the driver uses, under the names of the DBC files.

#include "drivers/odrive/odrive_messages.h"
#include "drivers/odrive/odrive_messages_05.h"
#include "drivers/odrive/odrive_messages_06.h"

namespace robot_control::odrive {

/// Calls `visit.template operator()<Message>(name)` for the messages that both firmwares have.
template <class Visit>
void visit_common(Visit visit) {
  visit.template operator()<SetAxisState>("Set_Axis_State");
  visit.template operator()<EncoderEstimates>("Get_Encoder_Estimates");
  visit.template operator()<SetControllerMode>("Set_Controller_Mode");
  visit.template operator()<SetInputVelocity>("Set_Input_Vel");
  visit.template operator()<SetInputTorque>("Set_Input_Torque");
  visit.template operator()<SetLimits>("Set_Limits");
  visit.template operator()<Iq>("Get_Iq");
  visit.template operator()<BusVoltageCurrent>("Get_Bus_Voltage_Current");
  visit.template operator()<SetVelocityGains>("Set_Vel_Gains");
}

template <class Visit>
void visit_05(Visit visit) {
  visit_common(visit);
  visit.template operator()<v05::Heartbeat>("Heartbeat");
  visit.template operator()<v05::MotorError>("Get_Motor_Error");
  visit.template operator()<v05::EncoderError>("Get_Encoder_Error");
  visit.template operator()<v05::ClearErrors>("Clear_Errors");
  visit.template operator()<v05::SetLinearCount>("Set_Linear_Count");
  visit.template operator()<v05::ControllerError>("Get_Controller_Error");
}

template <class Visit>
void visit_06(Visit visit) {
  visit_common(visit);
  visit.template operator()<v06::Version>("Get_Version");
  visit.template operator()<v06::Heartbeat>("Heartbeat");
  visit.template operator()<Estop>("Estop");
  visit.template operator()<v06::Error>("Get_Error");
  visit.template operator()<v06::RxSdo>("RxSdo");
  visit.template operator()<v06::TxSdo>("TxSdo");
  visit.template operator()<v06::Address>("Address");
  visit.template operator()<v06::Temperature>("Get_Temperature");
  visit.template operator()<v06::ClearErrors>("Clear_Errors");
  visit.template operator()<v06::SetAbsolutePosition>("Set_Absolute_Position");
  visit.template operator()<v06::Torques>("Get_Torques");
}

}  // namespace robot_control::odrive
