#!/usr/bin/env python3
from roomba_ros.driver.roomba_driver_node import main

main()
