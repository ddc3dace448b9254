#!/usr/bin/env python3
from roomba_ros.dashboard.dashboard_node import main

main()
