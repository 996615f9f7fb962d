// These are declarations of what docs/firmware_stm32.md uses of ST's HAL and CMSIS.
#pragma once
#include <stdint.h>

typedef struct {
  uint32_t counter, compare[2];
} TIM_HandleTypeDef;
typedef struct {
  uint32_t left;
} DMA_HandleTypeDef;
typedef enum { HAL_UART_STATE_READY } HAL_UART_StateTypeDef;
typedef struct {
  HAL_UART_StateTypeDef gState;
  DMA_HandleTypeDef* hdmarx;
} UART_HandleTypeDef;
typedef struct GPIO_TypeDef GPIO_TypeDef;
typedef enum { GPIO_PIN_RESET, GPIO_PIN_SET } GPIO_PinState;
typedef enum { HAL_OK } HAL_StatusTypeDef;
enum { TIM_CHANNEL_1, TIM_CHANNEL_2, TIM_CHANNEL_ALL };
enum { GPIO_PIN_0 = 1, GPIO_PIN_1 = 2, GPIO_PIN_2 = 4 };
extern GPIO_TypeDef* GPIOB;

#define __HAL_TIM_GET_COUNTER(timer) ((timer)->counter)
#define __HAL_TIM_SET_COMPARE(timer, channel, value) ((timer)->compare[channel] = (value))
#define __HAL_DMA_GET_COUNTER(dma) ((dma)->left)

void __disable_irq(void);
void __enable_irq(void);
void HAL_GPIO_WritePin(GPIO_TypeDef* port, uint16_t pin, GPIO_PinState state);
GPIO_PinState HAL_GPIO_ReadPin(GPIO_TypeDef* port, uint16_t pin);
HAL_StatusTypeDef HAL_TIM_Base_Start(TIM_HandleTypeDef* timer);
HAL_StatusTypeDef HAL_TIM_Encoder_Start(TIM_HandleTypeDef* timer, uint32_t channel);
HAL_StatusTypeDef HAL_TIM_PWM_Start(TIM_HandleTypeDef* timer, uint32_t channel);
HAL_StatusTypeDef HAL_UART_Receive_DMA(UART_HandleTypeDef* uart, uint8_t* bytes, uint16_t size);
HAL_StatusTypeDef HAL_UART_Transmit_DMA(UART_HandleTypeDef* uart, const uint8_t* bytes, uint16_t size);
