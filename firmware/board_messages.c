#include "board_messages.h"

enum { ORDER = 1, REPORT = 2 };
enum { ORDER_HEAD = 6, ORDER_WHEEL = 5, REPORT_HEAD = 28, REPORT_IMU = 30, REPORT_WHEEL = 9 };

static uint8_t* put(uint8_t* to, uint32_t value, uint8_t size) {
  for (uint8_t i = 0; i < size; ++i) to[i] = (uint8_t)(value >> (8u * i));
  return to + size;
}

static uint32_t take(const uint8_t** from, uint8_t size) {
  uint32_t value = 0;
  for (uint8_t i = 0; i < size; ++i) value |= (uint32_t)(*from)[i] << (8u * i);
  *from += size;
  return value;
}

uint8_t board_write_order(const struct board_order* order, uint8_t* body) {
  uint8_t* to = body;
  *to++ = BOARD_PROTOCOL;
  *to++ = ORDER;
  to = put(to, order->cycle, 2);
  *to++ = order->wheels;
  *to++ = order->outputs;
  for (uint8_t i = 0; i < order->wheels; ++i) {
    *to++ = order->wheel[i].mode;
    to = put(to, (uint32_t)order->wheel[i].value, 4);
  }
  return (uint8_t)(to - body);
}

uint8_t board_read_order(const uint8_t* body, uint8_t size, struct board_order* order) {
  const uint8_t* from = body + 2;
  if (size < ORDER_HEAD || body[0] != BOARD_PROTOCOL || body[1] != ORDER) return 0;
  order->cycle = (uint16_t)take(&from, 2);
  order->wheels = *from++;
  order->outputs = *from++;
  if (order->wheels > BOARD_MAX_WHEELS || size != ORDER_HEAD + ORDER_WHEEL * order->wheels) return 0;
  for (uint8_t i = 0; i < order->wheels; ++i) {
    order->wheel[i].mode = *from++;
    order->wheel[i].value = (int32_t)take(&from, 4);
  }
  return 1;
}

uint8_t board_write_report(const struct board_report* report, uint8_t* body) {
  const struct board_sensors* sensors = &report->sensors;
  uint8_t* to = body;
  *to++ = BOARD_PROTOCOL;
  *to++ = REPORT;
  to = put(to, report->cycle, 2);
  to = put(to, report->time_us, 4);
  to = put(to, report->delay_us, 2);
  *to++ = report->wheels;
  *to++ = report->flags;
  to = put(to, report->firmware, 2);
  to = put(to, report->lost, 2);
  to = put(to, report->bad, 2);
  *to++ = sensors->valid;
  *to++ = sensors->inputs;
  *to++ = sensors->reset;
  *to++ = 0;
  to = put(to, sensors->battery_mv, 2);
  to = put(to, (uint16_t)sensors->battery_ca, 2);
  to = put(to, (uint16_t)sensors->temperature_dc, 2);
  for (uint8_t i = 0; i < report->wheels; ++i) {
    to = put(to, report->counts[i], 4);
    to = put(to, (uint32_t)sensors->effort[i], 4);
    *to++ = sensors->fault[i];
  }
  if ((sensors->valid & BOARD_HAS_IMU) == 0) return (uint8_t)(to - body);
  to = put(to, sensors->imu.time_us, 4);
  to = put(to, sensors->imu.rate, 2);
  for (uint8_t i = 0; i < 3; ++i) to = put(to, (uint32_t)sensors->imu.angular_velocity[i], 4);
  for (uint8_t i = 0; i < 3; ++i) to = put(to, (uint32_t)sensors->imu.linear_acceleration[i], 4);
  return (uint8_t)(to - body);
}

uint8_t board_read_report(const uint8_t* body, uint8_t size, struct board_report* report) {
  struct board_sensors* sensors = &report->sensors;
  const uint8_t* from = body + 2;
  if (size < REPORT_HEAD || body[0] != BOARD_PROTOCOL || body[1] != REPORT) return 0;
  report->cycle = (uint16_t)take(&from, 2);
  report->time_us = take(&from, 4);
  report->delay_us = (uint16_t)take(&from, 2);
  report->wheels = *from++;
  report->flags = *from++;
  report->firmware = (uint16_t)take(&from, 2);
  report->lost = (uint16_t)take(&from, 2);
  report->bad = (uint16_t)take(&from, 2);
  sensors->valid = *from++;
  sensors->inputs = *from++;
  sensors->reset = *from++;
  ++from; /* reserved */
  sensors->battery_mv = (uint16_t)take(&from, 2);
  sensors->battery_ca = (int16_t)(uint16_t)take(&from, 2);
  sensors->temperature_dc = (int16_t)(uint16_t)take(&from, 2);
  const uint8_t imu_size = (sensors->valid & BOARD_HAS_IMU) != 0 ? REPORT_IMU : 0;
  if (report->wheels > BOARD_MAX_WHEELS || size != REPORT_HEAD + REPORT_WHEEL * report->wheels + imu_size) return 0;
  for (uint8_t i = 0; i < report->wheels; ++i) {
    report->counts[i] = take(&from, 4);
    sensors->effort[i] = (int32_t)take(&from, 4);
    sensors->fault[i] = *from++;
  }
  if (imu_size == 0) return 1;
  sensors->imu.time_us = take(&from, 4);
  sensors->imu.rate = (uint16_t)take(&from, 2);
  for (uint8_t i = 0; i < 3; ++i) sensors->imu.angular_velocity[i] = (int32_t)take(&from, 4);
  for (uint8_t i = 0; i < 3; ++i) sensors->imu.linear_acceleration[i] = (int32_t)take(&from, 4);
  return 1;
}
