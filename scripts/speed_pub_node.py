#!/usr/bin/env python3
from roomba_ros.speed_pub_node import main

main()
