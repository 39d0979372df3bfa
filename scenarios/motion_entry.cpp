    case MotionProfile::constant_ramp:
      return {{"acceleration_m_s2"}, {"ramp_s", "speed_m_s"}, {"distance_m", "bezier_m"}};
    case MotionProfile::constant_speed:
      return {{"speed_m_s"}, {"distance_m", "duration_s", "bezier_m"}};
