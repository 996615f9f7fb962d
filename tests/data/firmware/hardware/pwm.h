// These are declarations of what docs/firmware_pico.md uses of the Pico SDK.
#pragma once
#include "pico/stdlib.h"

uint pwm_gpio_to_slice_num(uint gpio);
void pwm_set_wrap(uint slice, uint16_t wrap);
void pwm_set_enabled(uint slice, bool enabled);
void pwm_set_gpio_level(uint gpio, uint16_t level);
