// These are declarations of what docs/firmware_arduino.md uses of Arduino's core.
#pragma once
#include <stddef.h>
#include <stdint.h>

enum { LOW, HIGH, INPUT_PULLUP, OUTPUT, CHANGE };

unsigned long micros();
void noInterrupts();
void interrupts();
void pinMode(uint8_t pin, uint8_t mode);
int digitalRead(uint8_t pin);
void digitalWrite(uint8_t pin, uint8_t value);
void analogWrite(uint8_t pin, int value);
int digitalPinToInterrupt(uint8_t pin);
void attachInterrupt(uint8_t interrupt, void (*function)(), int mode);

struct HardwareSerial {
  void begin(unsigned long bit_rate);
  int available();
  int availableForWrite();
  int read();
  size_t write(const uint8_t* bytes, size_t size);
};
extern HardwareSerial Serial;
