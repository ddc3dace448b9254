#!/usr/bin/env python3
from roomba_ros.speed.speed_pub_node import main

main()
