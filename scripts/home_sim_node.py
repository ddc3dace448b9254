#!/usr/bin/env python3
from roomba_ros.simulation.home_sim_node import main

main()
