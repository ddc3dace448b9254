#!/usr/bin/env python3
from roomba_ros.control_node import main

main()
