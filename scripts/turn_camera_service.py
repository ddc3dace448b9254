#!/usr/bin/env python3
from roomba_ros.camera.turn_camera_service import main

main()
