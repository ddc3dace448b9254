#!/usr/bin/env python3
from roomba_ros.dirt.dirt_pub_node import main

main()
