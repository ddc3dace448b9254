#!/usr/bin/env python3
from roomba_ros.client.control_node import main

main()
