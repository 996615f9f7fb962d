#ifndef ROBOT_CONTROL_BOARD_H
#define ROBOT_CONTROL_BOARD_H
/* The firmware of a motor board, without code of any board: portable C11, no heap, no floating point, no clock.
 *
 * The main loop calls `board_step` at least once per millisecond, with the bytes that came. In each call every wheel is
 * driven once. An order is refused if its protocol or its number of wheels differs, or a mode is not known; the board
 * then brakes and reports BOARD_REFUSED. Without a good order for `watchdog_us` it brakes as well.
 *
 * Velocity by a PI loop of the board, for a user whose `drive` has no loop of its own (velocity_loop = 1): once per
 * `loop_period_us`, with the speed v measured over that time in 1/256 counts per s,
 *
 *   pwm = (kf v* + kp (v* - v)) / 65536 + integral,   integral += ki (v* - v) / 65536
 *
 * clamped to `max_pwm`; the integral stands still while the clamp is in force. */

#include <stdint.h>

#include "board_frame.h"
#include "board_messages.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The five functions of the user. `context` is that of the configuration. */
struct board_functions {
  uint32_t (*time_us)(void* context);              /* free-running, modulo 2^32 */
  void (*counts)(void* context, uint32_t* counts); /* of all encoders, latched at one instant */
  void (*drive)(void* context, uint8_t wheel, enum board_mode mode,
                int32_t value); /* at once; BOARD_BRAKE holds or releases */
  void (*sensors)(void* context, uint8_t outputs, struct board_sensors* sensors);
  void (*write)(void* context, const uint8_t* bytes, uint8_t size); /* to the line; drops what does not fit */
};

struct board_config {
  void* context;
  struct board_functions functions;
  uint8_t wheels;        /* at most BOARD_MAX_WHEELS */
  uint16_t firmware;     /* version of the user's code */
  uint32_t watchdog_us;  /* 0: 50 000 */
  uint8_t velocity_loop; /* 1: the PI loop below turns BOARD_VELOCITY into BOARD_PWM */
  uint32_t loop_period_us;
  int32_t kf, kp, ki;
  int16_t max_pwm; /* 1/10000 */
};

struct board {
  struct board_config config;
  struct board_decoder decoder;
  struct board_order order; /* the one in force */
  uint32_t order_us;        /* when it came */
  uint8_t has_order;
  uint8_t braked; /* BOARD_WATCHDOG: by itself since the last order to brake */
  uint16_t lost;
  uint32_t loop_us; /* last step of the PI loop */
  uint32_t loop_counts[BOARD_MAX_WHEELS];
  int32_t integral[BOARD_MAX_WHEELS]; /* 1/65536 of a unit of pwm */
  int32_t pwm[BOARD_MAX_WHEELS];
};

void board_begin(struct board* board, const struct board_config* config);
void board_step(struct board* board, const uint8_t* bytes, uint8_t size);

#ifdef __cplusplus
}
#endif
#endif
