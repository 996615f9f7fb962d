// These are declarations of what docs/firmware_pico.md uses of the Pico SDK.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef unsigned int uint;
enum gpio_function { GPIO_FUNC_PWM = 4 };
enum { GPIO_OUT = 1, GPIO_IRQ_EDGE_FALL = 4, GPIO_IRQ_EDGE_RISE = 8 };
typedef void (*gpio_irq_callback_t)(uint gpio, uint32_t events);

bool stdio_init_all(void);
int putchar_raw(int byte);
int getchar_timeout_us(uint32_t timeout_us);
uint32_t time_us_32(void);
void gpio_init(uint gpio);
bool gpio_get(uint gpio);
void gpio_put(uint gpio, bool value);
void gpio_pull_up(uint gpio);
void gpio_set_dir(uint gpio, bool out);
void gpio_set_function(uint gpio, enum gpio_function function);
void gpio_set_irq_enabled_with_callback(uint gpio, uint32_t events, bool enabled, gpio_irq_callback_t callback);
