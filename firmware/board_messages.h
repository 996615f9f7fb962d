#ifndef ROBOT_CONTROL_BOARD_MESSAGES_H
#define ROBOT_CONTROL_BOARD_MESSAGES_H
/* The two messages between host and board (docs/board_protocol.md): the host sends an order in each cycle, and the
 * board answers each with one report. Numbers are integers, least significant byte first. */

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { BOARD_PROTOCOL = 1, BOARD_MAX_WHEELS = 4 };

/* A mode of a wheel, with the unit of its value. */
enum board_mode {
  BOARD_BRAKE = 0,    /* the board's own brake; no value */
  BOARD_EFFORT = 1,   /* uN m */
  BOARD_PWM = 2,      /* 1/10000 of the supply, signed */
  BOARD_VELOCITY = 3, /* 1/256 counts per s, which the board controls by itself */
};

enum board_validity { BOARD_HAS_EFFORT = 1, BOARD_HAS_BATTERY = 2, BOARD_HAS_TEMPERATURE = 4, BOARD_HAS_IMU = 8 };

/* Bits of inputs. A bit is set while a current flows through the closed contact, so that a broken wire clears it. */
enum board_input { BOARD_E_STOP_RELEASED = 1 };

enum board_flag {
  BOARD_WATCHDOG = 1, /* the watchdog expired, and no order to brake all wheels was answered since then */
  BOARD_REFUSED = 2,  /* the order was of another protocol or number of wheels, or had an unknown mode: it brakes */
};

enum board_reset { BOARD_POWER_ON = 0, BOARD_BROWN_OUT = 1, BOARD_RESET_BUTTON = 2, BOARD_RESET_WATCHDOG = 3 };

struct board_wheel_order {
  uint8_t mode; /* board_mode */
  int32_t value;
};

struct board_order {
  uint16_t cycle; /* of the host; a report repeats it */
  uint8_t wheels;
  uint8_t outputs; /* bits, for the user's code */
  struct board_wheel_order wheel[BOARD_MAX_WHEELS];
};

struct board_imu {
  uint32_t time_us;               /* of the sample, on the clock of the board */
  uint16_t rate;                  /* Hz */
  int32_t angular_velocity[3];    /* urad/s */
  int32_t linear_acceleration[3]; /* um/s2, the specific force */
};

struct board_sensors {
  uint8_t valid;                    /* board_validity */
  uint8_t inputs;                   /* board_input */
  uint8_t reset;                    /* board_reset */
  int32_t effort[BOARD_MAX_WHEELS]; /* uN m, measured */
  uint8_t fault[BOARD_MAX_WHEELS];  /* the user's codes; 0: none */
  uint16_t battery_mv;
  int16_t battery_ca;     /* 10 mA, positive when discharging */
  int16_t temperature_dc; /* 0.1 degrees Celsius */
  struct board_imu imu;
};

struct board_report {
  uint16_t cycle;    /* of the order that it answers */
  uint32_t time_us;  /* clock of the board when the order came; all counts are of this instant */
  uint16_t delay_us; /* from then until the report left */
  uint8_t wheels;
  uint8_t flags; /* board_flag */
  uint16_t firmware;
  uint16_t lost; /* orders that never came, by their cycles */
  uint16_t bad;  /* frames with an error */
  uint32_t counts[BOARD_MAX_WHEELS];
  struct board_sensors sensors;
};

/* Writes a body, which has room for BOARD_MAX_BODY bytes. Returns its size. */
uint8_t board_write_order(const struct board_order* order, uint8_t* body);
uint8_t board_write_report(const struct board_report* report, uint8_t* body);

/* Returns 1 for a message of this protocol that is complete. Otherwise `order` or `report` is undefined. */
uint8_t board_read_order(const uint8_t* body, uint8_t size, struct board_order* order);
uint8_t board_read_report(const uint8_t* body, uint8_t size, struct board_report* report);

#ifdef __cplusplus
}
#endif
#endif
