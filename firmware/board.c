#include "board.h"

static const uint32_t default_watchdog_us = 50000;
static const int32_t max_speed = 0x3FFFFFFF; /* 1/256 counts per s: the difference of two fits into 32 bits */
static const int32_t max_integral = 0x7FFFFFFF;

static int32_t clamped(int64_t value, int32_t limit) {
  return (int32_t)(value > limit ? limit : value < -limit ? -limit : value);
}

static void brake_all(struct board* board) {
  for (uint8_t i = 0; i < BOARD_MAX_WHEELS; ++i) {
    board->order.wheel[i].mode = BOARD_BRAKE;
    board->order.wheel[i].value = 0;
    board->integral[i] = 0;
    board->pwm[i] = 0;
  }
}

void board_begin(struct board* board, const struct board_config* config) {
  *board = (struct board){.braked = BOARD_WATCHDOG};
  board->config = *config;
  if (board->config.watchdog_us == 0) board->config.watchdog_us = default_watchdog_us;
  if (board->config.wheels > BOARD_MAX_WHEELS) board->config.wheels = BOARD_MAX_WHEELS;
  brake_all(board);
}

static void report(struct board* board, uint32_t time_us, uint16_t cycle, uint8_t flags) {
  const struct board_functions* functions = &board->config.functions;
  void* context = board->config.context;
  struct board_report report = {0};
  report.cycle = cycle;
  report.time_us = time_us;
  report.wheels = board->config.wheels;
  report.flags = flags;
  report.firmware = board->config.firmware;
  report.lost = board->lost;
  report.bad = board->decoder.bad;
  functions->counts(context, report.counts);
  functions->sensors(context, board->order.outputs, &report.sensors);
  const uint32_t delay_us = functions->time_us(context) - time_us;
  report.delay_us = (uint16_t)(delay_us > 0xFFFFu ? 0xFFFFu : delay_us);
  uint8_t body[BOARD_MAX_BODY];
  uint8_t frame[BOARD_MAX_FRAME];
  const uint8_t size = board_encode(body, board_write_report(&report, body), frame);
  if (size != 0) functions->write(context, frame, size);
}

static uint8_t is_known(const struct board* board, const struct board_order* order) {
  if (order->wheels != board->config.wheels) return 0;
  for (uint8_t i = 0; i < order->wheels; ++i) {
    if (order->wheel[i].mode > BOARD_VELOCITY) return 0;
  }
  return 1;
}

static uint8_t brakes(const struct board_order* order) {
  for (uint8_t i = 0; i < order->wheels; ++i) {
    if (order->wheel[i].mode != BOARD_BRAKE) return 0;
  }
  return 1;
}

static void receive(struct board* board, uint8_t size) {
  const uint32_t now_us = board->config.functions.time_us(board->config.context);
  struct board_order order = board->order;
  if (!board_read_order(board->decoder.body, size, &order) || !is_known(board, &order)) {
    brake_all(board);
    report(board, now_us, board->order.cycle, board->braked | BOARD_REFUSED);
    return;
  }
  const uint16_t step = (uint16_t)(order.cycle - board->order.cycle);
  if (board->has_order && step > 1 && step < 0x8000u) board->lost = (uint16_t)(board->lost + step - 1);
  for (uint8_t i = 0; i < order.wheels; ++i) {
    if (order.wheel[i].mode == board->order.wheel[i].mode) continue;
    board->integral[i] = 0;
    board->pwm[i] = 0;
  }
  board->order = order;
  board->order_us = now_us;
  board->has_order = 1;
  report(board, now_us, order.cycle, board->braked);
  if (brakes(&order)) board->braked = 0; /* a host that saw the flag brakes: one that lost this report sees the next */
}

static void run_velocity_loop(struct board* board, uint32_t now_us) {
  const struct board_config* config = &board->config;
  const uint32_t elapsed_us = now_us - board->loop_us;
  if (!config->velocity_loop || elapsed_us < config->loop_period_us || elapsed_us == 0) return;
  uint32_t counts[BOARD_MAX_WHEELS] = {0};
  config->functions.counts(config->context, counts);
  for (uint8_t i = 0; i < config->wheels; ++i) {
    const int32_t moved = (int32_t)(counts[i] - board->loop_counts[i]);
    const int32_t speed = clamped((int64_t)moved * 256 * 1000000 / elapsed_us, max_speed);
    board->loop_counts[i] = counts[i];
    if (board->order.wheel[i].mode != BOARD_VELOCITY) continue;
    const int32_t wanted = clamped(board->order.wheel[i].value, max_speed);
    const int32_t error = wanted - speed;
    const int64_t integral = board->integral[i] + (int64_t)config->ki * error;
    const int64_t sum = ((int64_t)config->kf * wanted + (int64_t)config->kp * error + integral) / 65536;
    board->pwm[i] = clamped(sum, config->max_pwm);
    if (board->pwm[i] == sum) board->integral[i] = clamped(integral, max_integral);
  }
  board->loop_us = now_us;
}

void board_step(struct board* board, const uint8_t* bytes, uint8_t size) {
  const struct board_config* config = &board->config;
  for (uint8_t i = 0; i < size; ++i) {
    const uint8_t body = board_decode(&board->decoder, bytes[i]);
    if (body != 0) receive(board, body);
  }
  const uint32_t now_us = config->functions.time_us(config->context);
  if (!board->has_order || now_us - board->order_us >= config->watchdog_us) {
    board->braked = BOARD_WATCHDOG;
    board->has_order = 0; /* the clock of the board wraps; an old order does not become new */
    brake_all(board);
  }
  run_velocity_loop(board, now_us);
  for (uint8_t i = 0; i < config->wheels; ++i) {
    const struct board_wheel_order* wheel = &board->order.wheel[i];
    const uint8_t by_loop = config->velocity_loop && wheel->mode == BOARD_VELOCITY;
    const enum board_mode mode = by_loop ? BOARD_PWM : (enum board_mode)wheel->mode;
    config->functions.drive(config->context, i, mode, by_loop ? board->pwm[i] : wheel->value);
  }
}
