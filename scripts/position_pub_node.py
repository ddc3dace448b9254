#!/usr/bin/env python3
from roomba_ros.position.position_pub_node import main

main()
