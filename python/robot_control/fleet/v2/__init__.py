"""VDA 5050 2.1.0 alone: messages, order rules, states. It needs no ROS, no MQTT and no clock.

Section numbers (6.6 …) are those of the standard's text. The folder schemas holds its schemas, unchanged, with their
licence.
"""
