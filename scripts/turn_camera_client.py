#!/usr/bin/env python3
from roomba_ros.camera.turn_camera_client import main

main()
